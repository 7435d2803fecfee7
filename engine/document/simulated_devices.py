"""A cell whose real devices, or some of them, are simulated: by one word, without a change of its document."""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import replace

from msgspec import structs

from engine.document.cell import Cell
from engine.document.robot_spec import RobotSpec
from engine.errors import DocumentError
from engine.wording.suggestions import did_you_mean

ALL_DEVICES = "all"
"""Stands for every device of a cell that has a driver."""


def with_simulated_devices(cell: Cell, names: Collection[str]) -> Cell:
    """Return the cell with these devices simulated by its world instead of driven.

    Args:
        cell: The cell; devices that are simulated already stay so.
        names: Robots with their tools (`left`), tools only (`left/gripper`), equipment (`vice`), or `all`.

    Raises:
        DocumentError: there is no such device, the cell has no world for robots or tools, or equipment names no pins.
    """
    if not names:
        return cell
    robots, equipment = cell.document.robots, cell.document.equipment
    known = {*robots, *equipment} | {f"{name}/gripper" for name, robot in robots.items() if robot.gripper}
    for name in names:
        if name != ALL_DEVICES and name not in known:
            hint = did_you_mean(name, {*known, ALL_DEVICES})
            raise DocumentError(f"{cell.name} has no device `{name}` to simulate", where="--simulate", hint=hint)
    chosen = known if ALL_DEVICES in names else set(names)
    if cell.document.world is None and not chosen <= set(equipment):
        hint = "add `world: {kind: mujoco}` to the cell"
        raise DocumentError("the cell has no world that could simulate its devices", where=cell.file, hint=hint)
    simulated = {
        device: driver
        for device, driver in cell.document.real_devices.items()
        if {device, device.partition("/")[0]} & chosen
    }
    replaced = {name: _simulated(name, robot, simulated) for name, robot in robots.items()}
    for name in {*equipment} & {*simulated}:
        if name not in cell.pins:
            where = cell.source.position(("equipment", name), of_key=True)
            hint = "add `pins: FILE`, the equipment document that its server has"
            raise DocumentError(
                f"equipment `{name}` cannot be simulated: nothing names its pins", where=where, hint=hint
            )
    in_memory = {name: structs.replace(one, driver="sim") for name, one in equipment.items() if name in simulated}
    document = structs.replace(cell.document, robots=replaced, equipment={**equipment, **in_memory})
    return replace(cell, document=document, simulated={**cell.simulated, **simulated})


def _simulated(name: str, robot: RobotSpec, devices: Collection[str]) -> RobotSpec:
    tool = robot.gripper
    if tool is not None and f"{name}/gripper" in devices:
        tool = structs.replace(tool, driver="sim")
    return structs.replace(robot, gripper=tool, driver="sim" if name in devices else robot.driver)
