"""Where states take arms, as far as that is known before a run: what a check asks of them and of the cell as drawn."""

from __future__ import annotations

from typing import Literal, Protocol

import msgspec

from engine.messages import Pose
from engine.skills.motion import PoseMatch


class ArmTarget(msgspec.Struct, frozen=True, kw_only=True):
    """A place that a state takes an arm to: `joints`, radians in the arm's order, or else the tool at `pose`.

    `parameter` is the parameter of the state that says so; `match` is what counts of the pose. The pose may be in the
    frame `world` or in that of the arm's base.
    """

    robot: str
    parameter: str
    joints: tuple[float, ...] = ()
    pose: Pose | None = None
    match: PoseMatch = "pose"


class ToolChange(msgspec.Struct, frozen=True, kw_only=True):
    """Puts the tool centre point of an arm elsewhere, so that poses mean another place."""

    robot: str


class StoredTargets(Protocol):
    """What the store of a cell begins with."""

    def joints(self, name: str) -> tuple[float, ...] | None:
        """Return the entry of kind `joints`, radians; None where there is none."""
        ...

    def pose(self, name: str) -> Pose | None:
        """Return the entry of kind `pose`; None where there is none."""
        ...


class TargetViolation(msgspec.Struct, frozen=True, kw_only=True):
    """Why an arm cannot be where it is to be taken."""

    kind: Literal["unreachable", "collision"]
    message: str
    hint: str = ""


class StaticCell(Protocol):
    """A cell as its document draws it: arms and fixtures, and no parts, which are meant to be touched and moved."""

    def fault(self, target: ArmTarget) -> TargetViolation | None:
        """Return why an arm cannot be at a target, None where it can be or nothing is known of it.

        All ways of standing there are looked at. Only the arm itself and fixtures count.

        Raises:
            CellError: the cell cannot be built.
        """
        ...
