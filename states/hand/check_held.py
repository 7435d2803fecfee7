"""hand.CheckHeld: checks whether a hand still holds a part."""

from __future__ import annotations

from typing import ClassVar

from engine.cause_chain import wrap_cause
from engine.errors import Cause
from engine.skills.hand import ReadHand
from engine.skills.part_label import PartLabel, part_label, wrong_part
from engine.state import Context, Outcome, Skills, State
from states.hand.hand_parameter_types import HandName, hand_address


class CheckHeld(State, frozen=True, kw_only=True):
    """Check whether a hand still holds a part; `lost` also when it holds another one."""

    state_name: ClassVar[str] = "hand.CheckHeld"
    skills: ClassVar[Skills] = (ReadHand,)
    outcomes: ClassVar[tuple[str, ...]] = ("held", "lost")
    success: ClassVar[tuple[str, ...]] = ("held",)
    observes: ClassVar[bool] = True

    hand: HandName
    part: PartLabel = ""

    async def run(self, ctx: Context) -> Outcome:
        """Read the measured state of the hand."""
        address = hand_address(self.hand)
        request = ReadHand()
        measured = await ctx.call(request, to=address)
        where = f"{address}/{request.skill_name()}"
        because = wrong_part(self.part, measured.part, where=where)
        if measured.held and because is None:
            return Outcome("held")
        because = because or Cause(
            message=f"the hand is closed to {measured.closed_percent:.0f} % and presses with {measured.force_n:.1f} N",
            where=where,
        )
        message = f"the hand of {self.hand} lost {part_label(self.part)}"
        return Outcome("lost", cause=wrap_cause(message, because, where=ctx.path, kind=self.state_name))
