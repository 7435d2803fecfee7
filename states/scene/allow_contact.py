"""scene.AllowContact: allows or forbids contact between two bodies."""

from __future__ import annotations

from typing import Annotated, ClassVar

from msgspec import Meta

from engine.skills import planning_scene
from engine.state import Context, Outcome, State
from states.call_or_fail import call_or_fail
from states.scene.scene_parameter_types import CELL, TouchingName


class AllowContact(State, frozen=True, kw_only=True):
    """Allow or forbid contact between two bodies, such as an arm and a soft mat, or a tool and its workpiece."""

    state_name: ClassVar[str] = "scene.AllowContact"
    outcomes: ClassVar[tuple[str, ...]] = ("set", "failed")
    success: ClassVar[tuple[str, ...]] = ("set",)

    first: TouchingName
    second: TouchingName
    allowed: Annotated[bool, Meta(description="True to allow contact, false to forbid it")] = True

    async def run(self, ctx: Context) -> Outcome:
        """Call the service of the cell."""
        request = planning_scene.AllowContact(first=self.first, second=self.second, allowed=self.allowed)
        what = f"the allowed contact between {self.first} and {self.second} was not changed"
        return await call_or_fail(ctx, request, to=CELL, done="set", what=what, kind=self.state_name)
