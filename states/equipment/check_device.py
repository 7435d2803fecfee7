"""equipment.CheckDevice: compares what is known of a device with a position."""

from __future__ import annotations

from typing import Annotated, ClassVar

import msgspec
from msgspec import Meta

from engine.errors import Cause
from engine.skills.device_moves import UNKNOWN, DeviceReading
from engine.state import Context, Outcome, State, nothing_to_undo
from states.equipment.device_parameter_types import DeviceName, DevicePositionName


class CheckDevice(State, frozen=True, kw_only=True):
    """Check that sensors tell a position; `unknown` where the device has no sensors for it.

    With `command_counts`, a device without sensors counts as there once it was told and its time has passed.
    """

    state_name: ClassVar[str] = "equipment.CheckDevice"
    outcomes: ClassVar[tuple[str, ...]] = ("at_position", "elsewhere", "unknown")
    success: ClassVar[tuple[str, ...]] = ("at_position",)
    undo = nothing_to_undo

    device: DeviceName
    position: DevicePositionName
    command_counts: Annotated[bool, Meta(description="Whether the command counts where nothing is sensed")] = False

    async def run(self, ctx: Context) -> Outcome:
        """Read the state and compare."""
        state = msgspec.convert(await ctx.latest_data(f"{self.device}/state"), DeviceReading)
        known = f"told {state.commanded or 'nothing'}, sensed {state.sensed}"
        if state.problem:
            return self._not("unknown", state.problem, ctx)
        if state.sensed == self.position:
            return Outcome("at_position")
        if state.sensed != UNKNOWN:
            return self._not("elsewhere", known, ctx)
        if self.command_counts and state.timed:
            at = state.commanded == self.position
            return Outcome("at_position") if at else self._not("elsewhere", known, ctx)
        return self._not("unknown", f"{known}; no sensor tells its positions", ctx)

    def _not(self, outcome: str, reason: str, ctx: Context) -> Outcome:
        message = f"{self.device} is not known to be at {self.position}"
        because = Cause(message=reason, where=f"{self.device}/state")
        return Outcome(outcome, cause=Cause(message=message, where=ctx.path, kind=self.state_name, because=because))
