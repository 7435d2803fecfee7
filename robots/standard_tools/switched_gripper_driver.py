"""The driver `switched_gripper`, as the entry point `flexcell.drivers` offers it, with its options."""

from __future__ import annotations

from engine.cell.drivers import Driver
from robots.switched.switched_options import SwitchedToolOptions


class SwitchedGripperOptions(SwitchedToolOptions, frozen=True, kw_only=True, tag="switched_gripper"):
    """A gripper that digital outputs of another device open and close."""


SWITCHED_GRIPPER = Driver(
    kind="switched_gripper",
    drives="gripper",
    options=SwitchedGripperOptions,
    capabilities=frozenset({"gripper"}),
    missing_skills={"gripper_move": "the gripper only opens and closes: outputs have no opening in between"},
    enabling="Permits switching; switches nothing. The device with the outputs has to be enabled as well.",
    ports={},
    proven="Never run on hardware. Tested at the outputs of emulated controllers of ABB and of servo arms.",
    page="docs/how-to/switch-a-tool-by-outputs.md",
    device="robots.drivers.switched_tool.new_switched_tool:new_switched_tool",
)
