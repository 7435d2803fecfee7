"""cell.Reach: lets a person of a simulated cell reach into it."""

from __future__ import annotations

from typing import Annotated, ClassVar

from msgspec import Meta

from engine.messages import Vector3
from engine.skills import people
from engine.skills.people import HandSpeed, StayTime
from engine.state import Context, Outcome, State
from states.cell.person_hand import PersonName, WaitForArrival, move_hand


class Reach(State, frozen=True, kw_only=True):
    """Let the hand of a person of a simulated cell move to a place, on a straight line, from now on.

    It replaces what that hand was doing. The person reaches on while the behavior goes on, unless `wait` says
    otherwise. What a real person does no behavior says: in a real cell this state stops the run.
    """

    state_name: ClassVar[str] = "cell.Reach"
    outcomes: ClassVar[tuple[str, ...]] = ("done", "failed")
    success: ClassVar[tuple[str, ...]] = ("done",)

    person: PersonName
    hand_m: Annotated[
        Vector3, Meta(description="Where the middle of the hand goes, in the world", extra_json_schema={"unit": "m"})
    ]
    speed_m_s: HandSpeed = 0.8
    stay_s: Annotated[
        StayTime | None,
        Meta(description="How long the hand stays before it goes back; for ever by default"),
    ] = None
    wait: WaitForArrival = False

    async def run(self, ctx: Context) -> Outcome:
        """Ask the cell, and wait for the hand where that is wanted."""
        request = people.Reach(person=self.person, hand_m=self.hand_m, speed_m_s=self.speed_m_s, stay_s=self.stay_s)
        what = f"{self.person} does not reach into the cell"
        return await move_hand(ctx, request, wait=self.wait, what=what, kind=self.state_name)
