"""The driver `switched_magnet`, as the entry point `flexcell.drivers` offers it, with its options."""

from __future__ import annotations

from engine.cell.drivers import Driver
from robots.switched.switched_options import SwitchedToolOptions


class SwitchedMagnetOptions(SwitchedToolOptions, frozen=True, kw_only=True, tag="switched_magnet"):
    """A magnet that digital outputs of another device switch."""


SWITCHED_MAGNET = Driver(
    kind="switched_magnet",
    drives="magnet",
    options=SwitchedMagnetOptions,
    capabilities=frozenset(),
    enabling="Permits switching; switches nothing. The device with the outputs has to be enabled as well.",
    ports={},
    proven="Never run on hardware. Tested at the output of an emulated controller of ABB.",
    page="docs/how-to/switch-a-tool-by-outputs.md",
    device="robots.drivers.switched_tool.new_switched_tool:new_switched_tool",
)
