"""scene.AllowContact: says whether two things may touch."""

from __future__ import annotations

from typing import Annotated, ClassVar

from msgspec import Meta

from engine.skills import planning_scene
from engine.state import Context, Outcome, State
from states.call_or_fail import call_or_fail
from states.scene.scene_parameter_types import CELL, TouchingName


class AllowContact(State, frozen=True, kw_only=True):
    """Let two things touch from now on, or no more: an arm and a soft mat, a tool and what it works on."""

    state_name: ClassVar[str] = "scene.AllowContact"
    outcomes: ClassVar[tuple[str, ...]] = ("set", "failed")
    success: ClassVar[tuple[str, ...]] = ("set",)

    first: TouchingName
    second: TouchingName
    allowed: Annotated[bool, Meta(description="Whether they may touch")] = True

    async def run(self, ctx: Context) -> Outcome:
        """Ask the cell."""
        request = planning_scene.AllowContact(first=self.first, second=self.second, allowed=self.allowed)
        what = f"whether {self.first} and {self.second} may touch was not changed"
        return await call_or_fail(ctx, request, to=CELL, done="set", what=what, kind=self.state_name)
