"""Whether a behavior that is written for one cell can be executed in another one."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import msgspec

from engine.check.behavior_check import check_given
from engine.document.behavior import Behavior
from engine.document.cell import Cell, load_cell
from engine.document.robot_spec import RobotSpec
from engine.errors import DocumentError
from engine.runtime.plan import Catalogue


class CellFit(msgspec.Struct, frozen=True, kw_only=True):
    """The cell that a behavior is written for, and why it cannot be executed in the connected one."""

    cell: str = ""
    """The name of that cell; empty if the behavior names none, or the cell cannot be read."""
    obstacle: str = ""
    """Empty if it can be executed."""


def cell_fit(behavior: Behavior, catalogue: Catalogue, cell: Cell | None) -> CellFit:
    """Compare the cell of a behavior with the connected one.

    Another cell fits if it has all that the behavior names, and the robots of the same names are of the same models.
    The simulated and the real cell of one place do, so each executes the behaviors of the other.

    Args:
        behavior: The behavior.
        catalogue: The states by name.
        cell: The connected cell; None without one, where everything fits.
    """
    if behavior.cell_file is None:
        return CellFit()
    try:
        own = load_cell(behavior.cell_file)
    except DocumentError:
        return CellFit()
    if cell is None or behavior.cell_file == cell.file.resolve():
        return CellFit(cell=own.name)
    reason = next(_differences(own, cell), "") or _missing(behavior, catalogue, cell)
    written = f"it is written for the cell {own.name}, and {cell.name} is connected"
    return CellFit(cell=own.name, obstacle=f"{written}: {reason}" if reason else "")


def _missing(behavior: Behavior, catalogue: Catalogue, cell: Cell) -> str:
    findings = check_given(behavior, catalogue, cell, {})
    return next((finding.message for finding in findings if finding.severity == "error"), "")


def _differences(own: Cell, connected: Cell) -> Iterator[str]:
    for name, robot in own.document.robots.items():
        other = connected.document.robots.get(name)
        if other is not None and (there := _models(own, robot)) != (here := _models(connected, other)):
            yield f"the robot {name} is {_words(there)} there and {_words(here)} here"


def _models(cell: Cell, robot: RobotSpec) -> tuple[str, ...]:
    """Return the models of an arm and its tool; those with a `/` are folders."""
    names = [robot.model, *([robot.gripper.model] if robot.gripper is not None else [])]
    return tuple(str(cell.resolve(name)) if "/" in name else name for name in names)


def _words(models: tuple[str, ...]) -> str:
    return " with ".join(Path(model).name for model in models)
