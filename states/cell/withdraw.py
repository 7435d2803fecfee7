"""cell.Withdraw: makes a simulated person withdraw the hand from the cell."""

from __future__ import annotations

from typing import ClassVar

from engine.skills import people
from engine.skills.people import HandSpeed
from engine.state import Context, Outcome, State
from states.cell.person_hand import PersonName, WaitForArrival, move_hand


class Withdraw(State, frozen=True, kw_only=True):
    """Move the hand of a simulated person back to its rest position."""

    state_name: ClassVar[str] = "cell.Withdraw"
    outcomes: ClassVar[tuple[str, ...]] = ("done", "failed")
    success: ClassVar[tuple[str, ...]] = ("done",)

    person: PersonName
    speed_m_s: HandSpeed = 0.8
    wait: WaitForArrival = False

    async def run(self, ctx: Context) -> Outcome:
        """Send the request to the cell, and wait for the hand if `wait` is true."""
        request = people.Withdraw(person=self.person, speed_m_s=self.speed_m_s)
        what = f"{self.person} does not withdraw"
        return await move_hand(ctx, request, wait=self.wait, what=what, kind=self.state_name)
