"""equipment.CheckHexapod: compares where the platform of a hexapod is with one of its poses."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, ClassVar

from engine.cause_chain import cause_of, wrap_cause
from engine.errors import Cause, SkillFailed
from engine.skills.hexapods import ReadHexapod
from engine.state import Context, Outcome, State, nothing_to_undo
from states.equipment.device_parameter_types import DeviceName
from states.equipment.hexapod_error import AngleTolerance, HexapodError, HexapodPoseName, PositionTolerance


class CheckHexapod(State, frozen=True, kw_only=True):
    """Check that a platform is shown at a pose, within 0.5 mm and 0.2° unless said otherwise; writes the error."""

    state_name: ClassVar[str] = "equipment.CheckHexapod"
    outcomes: ClassVar[tuple[str, ...]] = ("at_pose", "off", "failed")
    success: ClassVar[tuple[str, ...]] = ("at_pose",)
    outputs: ClassVar[Mapping[str, Any]] = {"error_m": float, "error_rad": float}
    unwritten: ClassVar[Mapping[str, tuple[str, ...]]] = {"failed": ("error_m", "error_rad")}
    undo = nothing_to_undo

    device: DeviceName
    pose: HexapodPoseName
    tolerance_m: PositionTolerance = 0.0005
    tolerance_rad: AngleTolerance = 0.0035

    async def run(self, ctx: Context) -> Outcome:
        """Read where it is and compare."""
        what = f"{self.device} is not at {self.pose}"
        try:
            reading = await ctx.call(ReadHexapod(pose=self.pose), to=self.device)
        except SkillFailed as error:
            return Outcome("failed", cause=wrap_cause(what, cause_of(error), where=ctx.path, kind=self.state_name))
        error = HexapodError.between(reading.platform, reading.target)
        if error.within(self.tolerance_m, self.tolerance_rad):
            return Outcome("at_pose", error.outputs)
        because = Cause(
            message=f"its platform is {error.words} away",
            where=f"{self.device}/{ReadHexapod.skill_name()}",
            compared=error.compared(self.tolerance_m, self.tolerance_rad),
        )
        return Outcome("off", error.outputs, wrap_cause(what, because, where=ctx.path, kind=self.state_name))
