"""gripper.CheckHeld: checks whether a gripper still holds a part."""

from __future__ import annotations

from typing import ClassVar

from engine.cause_chain import wrap_cause
from engine.errors import Cause
from engine.skills.gripper import ReadGripper
from engine.skills.part_label import PartLabel, part_label, wrong_part
from engine.state import Context, Outcome, Skills, State
from states.gripper.gripper_parameter_types import GripperName, gripper_address


class CheckHeld(State, frozen=True, kw_only=True):
    """Check whether the gripper still holds the part that it grasped; `lost` also when it holds another one."""

    state_name: ClassVar[str] = "gripper.CheckHeld"
    skills: ClassVar[Skills] = (ReadGripper,)
    outcomes: ClassVar[tuple[str, ...]] = ("held", "lost")
    success: ClassVar[tuple[str, ...]] = ("held",)
    observes: ClassVar[bool] = True

    gripper: GripperName
    part: PartLabel = ""

    async def run(self, ctx: Context) -> Outcome:
        """Read the measured state of the gripper."""
        address = gripper_address(self.gripper)
        request = ReadGripper()
        measured = await ctx.call(request, to=address)
        where = f"{address}/{request.skill_name()}"
        because = wrong_part(self.part, measured.part, where=where)
        if measured.held and because is None:
            return Outcome("held")
        because = because or Cause(
            message=f"the fingers are {measured.width_m * 1e3:.1f} mm apart and press with {measured.force_n:.1f} N",
            where=where,
        )
        message = f"{self.gripper} lost {part_label(self.part)}"
        return Outcome("lost", cause=wrap_cause(message, because, where=ctx.path, kind=self.state_name))
