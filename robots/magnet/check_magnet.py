"""magnet.CheckHeld: checks whether a magnet still holds a part."""

from __future__ import annotations

from typing import ClassVar

from engine.cause_chain import wrap_cause
from engine.errors import Cause
from engine.skills.part_label import PartLabel, part_label, wrong_part
from engine.state import Context, Outcome, State
from robots.magnet.magnet_parameter_types import MagnetName, magnet_address
from robots.magnet.magnet_skills import ReadMagnet


class CheckHeld(State, frozen=True, kw_only=True):
    """Check whether a magnet still holds a part; `lost` also when it holds another one."""

    state_name: ClassVar[str] = "magnet.CheckHeld"
    outcomes: ClassVar[tuple[str, ...]] = ("held", "lost")
    success: ClassVar[tuple[str, ...]] = ("held",)
    observes: ClassVar[bool] = True

    magnet: MagnetName
    part: PartLabel = ""

    async def run(self, ctx: Context) -> Outcome:
        """Read the measured state of the magnet."""
        address = magnet_address(self.magnet)
        request = ReadMagnet()
        measured = await ctx.call(request, to=address)
        where = f"{address}/{request.skill_name()}"
        because = wrong_part(self.part, measured.part, where=where)
        if measured.held and because is None:
            return Outcome("held")
        state = f"pulls with {measured.pull_n:.1f} N" if measured.on else "is switched off"
        because = because or Cause(message=f"the magnet {state}", where=where)
        message = f"the magnet of {self.magnet} lost {part_label(self.part)}"
        return Outcome("lost", cause=wrap_cause(message, because, where=ctx.path, kind=self.state_name))
