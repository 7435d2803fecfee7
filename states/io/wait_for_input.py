"""io.WaitForInput: waits until a digital input of a robot's controller is on, or off."""

from __future__ import annotations

from typing import Annotated, ClassVar

from msgspec import Meta

from engine.errors import Cause
from engine.state import Context, Outcome, State, nothing_to_undo
from states.io.input_parameter_types import (
    InputRobot,
    NameOfInput,
    NumberOfInput,
    input_value,
    input_words,
    require_one_name,
    unknown_input,
)
from states.time_limit import LongestWait, ended_within


class WaitForInput(State, frozen=True, kw_only=True):
    """Wait until an input has a value; it ends at once where it has.

    The input is given by its number (`input`) or by the name that the cell gives it (`name`). Inputs of real
    controllers are read 100 times a second, those of ABB twice: a shorter pulse may be missed.
    """

    state_name: ClassVar[str] = "io.WaitForInput"
    outcomes: ClassVar[tuple[str, ...]] = ("reached", "timeout", "unknown")
    success: ClassVar[tuple[str, ...]] = ("reached",)
    undo = nothing_to_undo

    robot: InputRobot
    input: NumberOfInput | None = None
    name: NameOfInput | None = None
    value: Annotated[bool, Meta(description="Value to wait for: true for on")] = True
    timeout_s: LongestWait | None = None

    def __post_init__(self) -> None:
        require_one_name(self.input, self.name)

    async def run(self, ctx: Context) -> Outcome:
        """Return that it has the value, the timeout, or why it is not known."""
        try:
            unknown = await ended_within(ctx, self._ended(ctx), self.timeout_s)
        except TimeoutError:
            message = f"{self._what} was not {'on' if self.value else 'off'} within {self.timeout_s:g} s"
            return Outcome("timeout", cause=Cause(message=message, where=ctx.path, kind=self.state_name))
        if unknown:
            return Outcome("unknown", cause=unknown_input(unknown, self._what, where=ctx.path, kind=self.state_name))
        return Outcome("reached")

    @property
    def _what(self) -> str:
        return input_words(self.robot, self.input, self.name)

    async def _ended(self, ctx: Context) -> str:
        """Return once it has the value, or why it is not known."""
        topic = f"{self.robot}/digital_inputs"
        value = self._value(await ctx.latest_data(topic))
        if value == (not self.value):
            value = self._value(await ctx.next_data(topic, lambda data: self._value(data) != (not self.value)))
        return value if isinstance(value, str) else ""

    def _value(self, data: object) -> bool | str:
        return input_value(data, self.input, self.name)
