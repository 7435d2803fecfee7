"""cell.Reach: makes a simulated person reach into the cell."""

from __future__ import annotations

from typing import Annotated, ClassVar

from msgspec import Meta

from engine.messages import Vector3
from engine.skills import people
from engine.skills.people import HandSpeed, StayTime
from engine.state import Context, Outcome, State
from states.cell.person_hand import PersonName, WaitForArrival, move_hand


class Reach(State, frozen=True, kw_only=True):
    """Move the hand of a simulated person to a position on a straight line.

    It replaces the current motion of that hand. The behavior continues during the motion unless `wait` is true. A
    behavior cannot command a real person: in a real cell this state stops the run.
    """

    state_name: ClassVar[str] = "cell.Reach"
    outcomes: ClassVar[tuple[str, ...]] = ("done", "failed")
    success: ClassVar[tuple[str, ...]] = ("done",)

    person: PersonName
    hand_m: Annotated[
        Vector3, Meta(description="Target of the hand's centre, in the world frame", extra_json_schema={"unit": "m"})
    ]
    speed_m_s: HandSpeed = 0.8
    stay_s: Annotated[
        StayTime | None,
        Meta(description="Time at the target before the hand returns; unlimited by default"),
    ] = None
    wait: WaitForArrival = False

    async def run(self, ctx: Context) -> Outcome:
        """Send the request to the cell, and wait for the hand if `wait` is true."""
        request = people.Reach(person=self.person, hand_m=self.hand_m, speed_m_s=self.speed_m_s, stay_s=self.stay_s)
        what = f"{self.person} does not reach into the cell"
        return await move_hand(ctx, request, wait=self.wait, what=what, kind=self.state_name)
