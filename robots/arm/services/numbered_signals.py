"""The digital inputs and outputs of a robot's controller that a cell document gives a name or a use."""

from __future__ import annotations

from typing import Literal

from engine.document import Cell
from engine.errors import CellError


def require_signals(
    cell: Cell, arm: str, kind: Literal["input", "output"], *, count: int, owner: str
) -> dict[str, int]:
    """Return the named inputs, or the used outputs, of an arm with their numbers.

    Args:
        cell: The cell.
        arm: The arm's name in it.
        kind: Which of both.
        count: How many there are.
        owner: Whose they are, for the message.

    Raises:
        CellError: the cell names a missing one; with its position.
    """
    robot = cell.document.robots[arm]
    signals = {str(name): number for name, number in (robot.inputs if kind == "input" else robot.outputs).items()}
    for name, number in signals.items():
        if number >= count:
            raise CellError(
                f"{arm} has no {kind} {number} for {name}",
                where=cell.source.position(("robots", arm, f"{kind}s", name)),
                hint=f"{owner} has {f'the {kind}s 0 to {count - 1}' if count else f'no {kind}s'}",
            )
    return signals
