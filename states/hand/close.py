"""hand.Close: closes a hand to a percentage and checks whether it holds a part."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, ClassVar

from engine.cause_chain import wrap_cause
from engine.errors import Cause
from engine.skills.hand import HandClose, HandResult
from engine.skills.part_label import PartLabel, part_label, wrong_part
from engine.state import Context, Outcome, Skills, State, goal_cause
from states.hand.hand_parameter_types import ClosingTime, HandName, Percent, hand_address


class Close(State, frozen=True, kw_only=True):
    """Close a hand to `percent` within `time_s`: `held` when thumb or palm and fingers press on a part, else `missed`.

    `missed` also when it holds another part than `part`; a hand that cannot name what it touches reports
    `by: current`. Always writes `held`; writes the final closing `closed_percent` if the hand measured it.
    """

    state_name: ClassVar[str] = "hand.Close"
    skills: ClassVar[Skills] = (HandClose,)
    outcomes: ClassVar[tuple[str, ...]] = ("held", "missed", "failed")
    success: ClassVar[tuple[str, ...]] = ("held",)
    outputs: ClassVar[Mapping[str, Any]] = {"held": bool, "closed_percent": float}
    unwritten: ClassVar[Mapping[str, tuple[str, ...]]] = {"failed": ("closed_percent",)}

    hand: HandName
    percent: Percent
    time_s: ClosingTime = 1.0
    part: PartLabel = ""

    def resources(self) -> tuple[str, ...]:
        """Return the hand."""
        return (hand_address(self.hand),)

    async def run(self, ctx: Context) -> Outcome:
        """Send the goal and return whether the hand holds the part."""
        address = hand_address(self.hand)
        goal = HandClose(percent=self.percent, time_s=self.time_s)
        end = await ctx.perform(goal, to=address)
        if end.status != "succeeded" or end.result is None:
            cause = goal_cause(self._failure(), goal, end, to=address, where=ctx.path, kind=self.state_name)
            return Outcome("failed", {"held": False}, cause)
        where = f"{address}/{goal.skill_name()}"
        wrong = wrong_part(self.part, end.result.part, where=where)
        held = end.result.held and wrong is None
        outputs = {"held": held, "closed_percent": end.result.closed_percent}
        if held:
            return Outcome("held", outputs)
        because = wrong or _missed_cause(end.result, where)
        return Outcome("missed", outputs, wrap_cause(self._failure(), because, where=ctx.path, kind=self.state_name))

    def _failure(self) -> str:
        return f"the hand of {self.hand} does not hold {part_label(self.part)}"


def _missed_cause(result: HandResult, address: str) -> Cause:
    return Cause(message=result.reason or "nothing is held and the hand gave no reason", where=address)
