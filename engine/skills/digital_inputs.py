"""Digital inputs of a robot's controller: what sensors, doors and machines tell it."""

from __future__ import annotations

from typing import Annotated

import msgspec

from engine.messages import Message
from engine.skill import Service
from engine.skills.switch_result import SwitchResult

InputNumber = Annotated[int, msgspec.Meta(ge=0, description="Number of the input, from 0")]


class DigitalInputs(Message, frozen=True, kw_only=True):
    """All inputs by number; the latest value of `<device>/digital_inputs`.

    `names` are those of the cell document or of equipment, with their numbers. With a `problem` nothing is known of
    them, and there are no `values`.
    """

    values: tuple[bool, ...]
    names: dict[str, int] = {}
    problem: str = ""


class SimulateInput(Service[SwitchResult], frozen=True, kw_only=True):
    """Turn an input of a simulated controller on or off, as a sensor would; real controllers do not offer it."""

    input: InputNumber | None = None
    name: Annotated[str, msgspec.Meta(description="Name of the input, instead of its number")] = ""
    value: Annotated[bool, msgspec.Meta(description="True to turn on, false to turn off")]

    def __post_init__(self) -> None:
        """Refuse none of both, and both."""
        if (self.input is None) == (not self.name):
            raise ValueError("give either `input` or `name`")
