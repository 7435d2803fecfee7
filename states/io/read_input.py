"""io.ReadInput: branches on a digital input of a robot's controller."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, ClassVar

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


class ReadInput(State, frozen=True, kw_only=True):
    """Branch on an input, by its number (`input`) or by the name that the cell gives it (`name`).

    In a behavior tree it is evaluated again at every change of an input of the robot.
    """

    state_name: ClassVar[str] = "io.ReadInput"
    outcomes: ClassVar[tuple[str, ...]] = ("on", "off", "unknown")
    success: ClassVar[tuple[str, ...]] = ("on",)
    outputs: ClassVar[Mapping[str, Any]] = {"value": bool}
    unwritten: ClassVar[Mapping[str, tuple[str, ...]]] = {"unknown": ("value",)}
    observes: ClassVar[bool] = True
    undo = nothing_to_undo

    robot: InputRobot
    input: NumberOfInput | None = None
    name: NameOfInput | None = None

    def __post_init__(self) -> None:
        require_one_name(self.input, self.name)

    async def run(self, ctx: Context) -> Outcome:
        """Return whether it is on."""
        value = input_value(await ctx.latest_data(f"{self.robot}/digital_inputs"), self.input, self.name)
        what = input_words(self.robot, self.input, self.name)
        if isinstance(value, str):
            return Outcome("unknown", cause=unknown_input(value, what, where=ctx.path, kind=self.state_name))
        if value:
            return Outcome("on", {"value": True})
        because = Cause(message=f"{what} is off", where=ctx.path, kind=self.state_name)
        return Outcome("off", {"value": False}, cause=because)
