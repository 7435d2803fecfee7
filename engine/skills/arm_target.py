"""Targets of arms that are known before a run, for checks of states against the static cell."""

from __future__ import annotations

from typing import Literal, Protocol

import msgspec

from engine.messages import Pose
from engine.skills.motion import PoseMatch


class ArmTarget(msgspec.Struct, frozen=True, kw_only=True):
    """A target that a state moves an arm to: `joints`, radians in the arm's order, or the tool at `pose`.

    `parameter` is the state's parameter that defines the target, and `index` its place there if that is a list;
    `match` selects the components of the pose to reach.
    The pose may be in the frame `world`, in that of the arm's base, or in a named frame of the cell.
    """

    robot: str
    parameter: str
    index: int | None = None
    joints: tuple[float, ...] = ()
    pose: Pose | None = None
    match: PoseMatch = "pose"


class ToolChange(msgspec.Struct, frozen=True, kw_only=True):
    """Changes the tool centre point of an arm, so that poses refer to another point."""

    robot: str


class StoredTargets(Protocol):
    """The initial entries of a cell's store."""

    def joints(self, name: str) -> tuple[float, ...] | None:
        """Return the entry of kind `joints`, radians; None when there is none."""
        ...

    def pose(self, name: str) -> Pose | None:
        """Return the entry of kind `pose`; None when there is none."""
        ...


class TargetViolation(msgspec.Struct, frozen=True, kw_only=True):
    """The reason why an arm cannot reach a target."""

    kind: Literal["unreachable", "collision"]
    message: str
    hint: str = ""


class StaticCell(Protocol):
    """The static cell of a document: arms and fixtures without parts, which are meant to be touched and moved."""

    def fault(self, target: ArmTarget) -> TargetViolation | None:
        """Return why an arm cannot be at a target; None when it can, or when the arm is unknown.

        Checks all configurations for the target, for collisions with the arm itself and with fixtures.

        Raises:
            CellError: the cell cannot be built.
        """
        ...
