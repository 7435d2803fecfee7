"""Makes the device of a switched tool from its options, whatever its kind."""

from __future__ import annotations

from typing import cast

from engine.cell.drivers import DeviceContext, DeviceReport, installed_driver
from engine.clock import Clock
from engine.errors import CellError
from engine.wording import did_you_mean
from robots.drivers.switched_tool.switched_tool import SwitchedTool
from robots.scene.scene_builder import driven_arm
from robots.sim.grip.tool_summary import tool_summary
from robots.switched.switched_kind import SwitchedKind
from robots.switched.switched_options import SwitchedToolOptions
from robots.tool_kinds import load_switched


def new_switched_tool(options: SwitchedToolOptions, *, name: str, clock: Clock, context: DeviceContext) -> SwitchedTool:
    """Return the tool, not yet connected.

    Raises:
        CellError: time is virtual, the cell has no device or topic of that name, or the tool is of another kind.
        DocumentError: a model folder is invalid.
    """
    if clock.virtual:
        hint = "run it in real time: without `--clock virtual`; or simulate it with `driver: sim`"
        raise CellError("a real tool has no virtual time", where=name, hint=hint)
    document, kind = context.cell.document, name.rpartition("/")[2]
    owner = options.device or context.robot
    if owner not in {*document.robots, *document.equipment}:
        hint = did_you_mean(owner, (*document.robots, *document.equipment))
        raise CellError(f"`device` is {owner}, which the cell does not have", where=name, hint=hint)
    if any(isinstance(pin, str) != (owner in document.equipment) for pin in options.pins()):
        how = "by their names in its document" if owner in document.equipment else "by their numbers"
        raise CellError(f"the outputs and inputs of {owner} are given {how}", where=name)
    if options.sensor is not None and options.sensor.topic and options.sensor.topic not in document.topics:
        hint = f"declare it: `topics: {{{options.sensor.topic}: {{type: boolean}}}}`"
        raise CellError(f"the cell declares no topic {options.sensor.topic}", where=name, hint=hint)
    tool = tool_summary(driven_arm(context.robot, document.robots[context.robot], context.cell.resolve).robot().tool)
    if tool is None or tool.kind != kind:
        raise CellError(f"the model of this tool is no {kind}", where=name, hint="another driver is for it")
    driver = installed_driver(str(options.__struct_config__.tag))
    about = DeviceReport(
        device=name,
        driver=driver.kind,
        address=f"{owner}, output {options.hold_output}",
        capabilities=tuple(sorted(driver.capabilities)),
        proven=driver.proven,
    )
    return SwitchedTool(
        name,
        options,
        kind=cast("SwitchedKind", load_switched(kind)),
        tool=tool,
        owner=owner,
        devices=context.devices,
        about=about,
    )
