"""motion.LearnJointDmp and motion.LearnCartDmp: learn a movement primitive from a recorded motion."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Annotated, Any, ClassVar

import msgspec
from msgspec import Meta

from engine.cause_chain import cause_of, wrap_cause
from engine.errors import SkillFailed
from engine.skills import dmp
from engine.skills.entries import WriteEntry
from engine.state import Context, Outcome, State
from states.motion.motion_target import RobotName

Recording = Annotated[
    str,
    Meta(
        min_length=1,
        description="Name of the recorded motion, an entry of kind `trajectory`",
        extra_json_schema={"entry": "trajectory"},
    ),
]


def _new_entry(kind: str) -> Meta:
    description = f"Name of the entry of kind `{kind}` to write"
    return Meta(min_length=1, description=description, extra_json_schema={"new_entry": kind})


class LearnJointDmp(State, frozen=True, kw_only=True):
    """Learn a joint-space movement primitive from a recorded motion and store it as an entry of kind `dmp`.

    Writes the fit error against the recording: `max_rad` over all joints and times, and `rms_rad`.
    """

    state_name: ClassVar[str] = "motion.LearnJointDmp"
    outcomes: ClassVar[tuple[str, ...]] = ("learned", "failed")
    success: ClassVar[tuple[str, ...]] = ("learned",)
    outputs: ClassVar[Mapping[str, Any]] = {"rms_rad": float, "max_rad": float}
    unwritten: ClassVar[Mapping[str, tuple[str, ...]]] = {"failed": ("rms_rad", "max_rad")}

    robot: RobotName
    recording: Recording
    save_as: Annotated[str, _new_entry("dmp")]
    kernels: Annotated[dmp.Kernels, Meta(description="Number of kernels; 0 chooses it from the fit")] = 0

    async def run(self, ctx: Context) -> Outcome:
        """Learn and store; a recording that cannot be learned from gives the outcome `failed`."""
        try:
            learned = await ctx.call(dmp.LearnJointDmp(entry=self.recording, N=self.kernels), to=self.robot)
        except SkillFailed as error:
            message = f"no movement primitive was learned from trajectory entry {self.recording}"
            return Outcome("failed", cause=wrap_cause(message, cause_of(error), where=ctx.path, kind=self.state_name))
        value = msgspec.to_builtins(learned.dmp)
        await ctx.call(WriteEntry(kind="dmp", name=self.save_as, value=value), to="store")
        return Outcome("learned", {"rms_rad": learned.fit.rms_rad, "max_rad": learned.fit.max_rad})


class LearnCartDmp(State, frozen=True, kw_only=True):
    """Learn a Cartesian movement primitive from a recorded motion and store it as an entry of kind `cart_dmp`.

    Writes the maximum fit error against the recording, in position and orientation.
    """

    state_name: ClassVar[str] = "motion.LearnCartDmp"
    outcomes: ClassVar[tuple[str, ...]] = ("learned", "failed")
    success: ClassVar[tuple[str, ...]] = ("learned",)
    outputs: ClassVar[Mapping[str, Any]] = {"max_m": float, "max_rad": float}
    unwritten: ClassVar[Mapping[str, tuple[str, ...]]] = {"failed": ("max_m", "max_rad")}

    robot: RobotName
    recording: Recording
    save_as: Annotated[str, _new_entry("cart_dmp")]
    kernels: Annotated[dmp.Kernels, Meta(description="Number of kernels; 0 chooses it from the fit")] = 0

    async def run(self, ctx: Context) -> Outcome:
        """Learn and store; a recording that cannot be learned from gives the outcome `failed`."""
        try:
            learned = await ctx.call(dmp.LearnCartDmp(entry=self.recording, N=self.kernels), to=self.robot)
        except SkillFailed as error:
            message = f"no movement primitive was learned from trajectory entry {self.recording}"
            return Outcome("failed", cause=wrap_cause(message, cause_of(error), where=ctx.path, kind=self.state_name))
        value = msgspec.to_builtins(learned.dmp)
        await ctx.call(WriteEntry(kind="cart_dmp", name=self.save_as, value=value), to="store")
        return Outcome("learned", {"max_m": learned.fit.max_m, "max_rad": learned.fit.max_rad})
