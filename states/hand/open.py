"""hand.Open: opens a hand fully."""

from __future__ import annotations

from typing import ClassVar

from engine.skills.hand import HandOpen
from engine.skills.part_label import PartLabel
from engine.state import Context, Outcome, Skills, State, goal_cause
from states.hand.hand_parameter_types import ClosingTime, HandName, hand_address


class Open(State, frozen=True, kw_only=True):
    """Open a hand fully within `time_s`."""

    state_name: ClassVar[str] = "hand.Open"
    skills: ClassVar[Skills] = (HandOpen,)
    outcomes: ClassVar[tuple[str, ...]] = ("opened", "failed")
    success: ClassVar[tuple[str, ...]] = ("opened",)

    hand: HandName
    time_s: ClosingTime = 1.0
    part: PartLabel = ""

    def resources(self) -> tuple[str, ...]:
        """Return the hand."""
        return (hand_address(self.hand),)

    async def run(self, ctx: Context) -> Outcome:
        """Send the goal and return the outcome of its end."""
        address = hand_address(self.hand)
        goal = HandOpen(time_s=self.time_s)
        end = await ctx.perform(goal, to=address)
        if end.status == "succeeded":
            return Outcome("opened")
        what = f"the hand of {self.hand} did not open" + (f" to release part {self.part}" if self.part else "")
        return Outcome("failed", cause=goal_cause(what, goal, end, to=address, where=ctx.path, kind=self.state_name))
