"""Small states for the tests of the static check and of signatures."""

from __future__ import annotations

from typing import Annotated, Any, ClassVar

from msgspec import Meta

from engine.messages import Pose
from engine.state import Context, Outcome, State


class Move(State, frozen=True, kw_only=True):
    """Move an arm.

    A second paragraph.
    """

    state_name: ClassVar[str] = "arm.Move"
    outcomes: ClassVar[tuple[str, ...]] = ("reached", "failed")
    success: ClassVar[tuple[str, ...]] = ("reached",)

    robot: str
    speed: Annotated[float, Meta(gt=0.0, le=1.0, description="Share of the limits")] = 0.5
    target: dict[str, str] | None = None
    pose: Pose | None = None

    def resources(self) -> tuple[str, ...]:
        """The arm."""
        return (self.robot,)

    async def run(self, ctx: Context) -> Outcome:
        """Arrive at once."""
        return Outcome("reached")


class Look(State, frozen=True, kw_only=True):
    """Look for a part."""

    state_name: ClassVar[str] = "camera.Look"
    outcomes: ClassVar[tuple[str, ...]] = ("seen", "empty")
    outputs: ClassVar[dict[str, Any]] = {"part": str}

    async def run(self, ctx: Context) -> Outcome:
        """See nothing."""
        return Outcome("empty")


class Pick(State, frozen=True, kw_only=True):
    """Pick a part that was seen."""

    state_name: ClassVar[str] = "arm.Pick"
    outcomes: ClassVar[tuple[str, ...]] = ("held",)

    async def run(self, ctx: Context, *, part: str, tries: int = 3) -> Outcome:
        """Hold it."""
        return Outcome("held")


class Maze(State, frozen=True, kw_only=True):
    """Leave a maze by one of eight ways."""

    state_name: ClassVar[str] = "maze.Leave"
    outcomes: ClassVar[tuple[str, ...]] = tuple(f"way{i}" for i in range(8))

    async def run(self, ctx: Context) -> Outcome:
        """Take the first way."""
        return Outcome("way0")


CATALOGUE: dict[str, type[State]] = {state.state_name: state for state in (Move, Look, Pick, Maze)}
