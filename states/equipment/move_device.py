"""equipment.MoveDevice: moves a device of the cell to one of its positions."""

from __future__ import annotations

from typing import ClassVar

from engine.errors import Cause
from engine.skills import device_moves
from engine.state import Context, Outcome, Skills, State, goal_cause
from states.equipment.device_parameter_types import DeviceName, DevicePositionName


class MoveDevice(State, frozen=True, kw_only=True):
    """Move a device to a position: `reached` where sensors tell it, `timed` where only its time has passed.

    Nothing tells then that it is there, or that it holds anything: a sensor or a robot that pulls can. `no_air`,
    `stuck` and `sensor_contradicts` are seen by sensors only; `interlocked` leaves all outputs as they are.
    """

    state_name: ClassVar[str] = "equipment.MoveDevice"
    skills: ClassVar[Skills] = (device_moves.MoveDevice,)
    outcomes: ClassVar[tuple[str, ...]] = (
        *("reached", "timed", "no_air", "stuck", "sensor_contradicts", "interlocked", "failed"),
    )
    success: ClassVar[tuple[str, ...]] = ("reached", "timed")

    device: DeviceName
    position: DevicePositionName

    def resources(self) -> tuple[str, ...]:
        """Return the device."""
        return (self.device,)

    async def run(self, ctx: Context) -> Outcome:
        """Send the goal and return how it ended."""
        goal = device_moves.MoveDevice(position=self.position)
        end = await ctx.perform(goal, to=self.device)
        what = f"{self.device} did not move to {self.position}"
        result = end.result
        if end.status != "succeeded" or result is None or result.ended == "canceled":
            cause = goal_cause(what, goal, end, to=self.device, where=ctx.path, kind=self.state_name)
            return Outcome("failed", cause=cause)
        if result.ended in self.success:
            return Outcome(result.ended)
        reason = Cause(message=result.reason, where=goal.address(self.device))
        return Outcome(result.ended, cause=Cause(message=what, where=ctx.path, kind=self.state_name, because=reason))
