"""magnet.Off: switches a magnet off."""

from __future__ import annotations

from typing import ClassVar

from engine.cause_chain import wrap_cause
from engine.errors import Cause
from engine.skills.part_label import UNKNOWN_BODY, PartLabel
from engine.state import Context, Outcome, State, goal_cause
from robots.magnet.magnet_parameter_types import MagnetName, magnet_address
from robots.magnet.magnet_skills import MagnetSwitch


class Off(State, frozen=True, kw_only=True):
    """Switch a magnet off; `failed` when it reports that it still holds a part."""

    state_name: ClassVar[str] = "magnet.Off"
    outcomes: ClassVar[tuple[str, ...]] = ("released", "failed")
    success: ClassVar[tuple[str, ...]] = ("released",)

    magnet: MagnetName
    part: PartLabel = ""

    def resources(self) -> tuple[str, ...]:
        """Return the magnet."""
        return (magnet_address(self.magnet),)

    async def run(self, ctx: Context) -> Outcome:
        """Send the goal and return the outcome of its end."""
        address = magnet_address(self.magnet)
        goal = MagnetSwitch(on=False)
        what = f"the magnet of {self.magnet} did not release " + (f"part {self.part}" if self.part else "its part")
        end = await ctx.perform(goal, to=address)
        if end.status != "succeeded" or end.result is None:
            cause = goal_cause(what, goal, end, to=address, where=ctx.path, kind=self.state_name)
            return Outcome("failed", cause=cause)
        if not end.result.held:
            return Outcome("released")
        held = f" at {end.result.part}" if end.result.part not in ("", UNKNOWN_BODY) else ""
        because = Cause(
            message=f"it still pulls{held} with {end.result.pull_n:.1f} N", where=f"{address}/{goal.skill_name()}"
        )
        return Outcome("failed", cause=wrap_cause(what, because, where=ctx.path, kind=self.state_name))
