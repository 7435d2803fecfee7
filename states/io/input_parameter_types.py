"""The parameters of the states that read digital inputs, and the input that they mean."""

from __future__ import annotations

from typing import Annotated

import msgspec
from msgspec import Meta

from engine.errors import Cause
from engine.skills.digital_inputs import DigitalInputs, InputNumber

InputRobot = Annotated[
    str,
    Meta(
        min_length=1,
        description="The robot whose controller has the input, or the equipment",
        extra_json_schema={"cell_name": "controller"},
    ),
]
NumberOfInput = Annotated[InputNumber, Meta(extra_json_schema={"cell_name": "input", "of": "robot"})]
NameOfInput = Annotated[
    str,
    Meta(
        min_length=1,
        description="Name that the cell gives to one of the inputs, or name of a pin",
        extra_json_schema={"cell_name": "input", "of": "robot"},
    ),
]


def require_one_name(number: int | None, name: str | None) -> None:
    """Refuse none of both, and both; raises ValueError."""
    if (number is None) == (name is None):
        raise ValueError("give either `input` or `name`")


def input_words(robot: str, number: int | None, name: str | None) -> str:
    """Return an input as messages call it."""
    return f"{name or f'input {number}'} of {robot}"


def input_value(message: object, number: int | None, name: str | None) -> bool | str:
    """Return the value of an input in a message of `digital_inputs` as plain data, or why it is not known."""
    state = msgspec.convert(message, DigitalInputs)
    if state.problem:
        return state.problem
    index = state.names.get(name) if name is not None else number
    if index is None:
        return f"there is no input {name}; the cell names {', '.join(state.names) or 'none'}"
    if index >= len(state.values):
        return f"there is no input {index}; the inputs are 0 to {len(state.values) - 1}"
    return state.values[index]


def unknown_input(reason: str, what: str, *, where: str, kind: str) -> Cause:
    """Return the cause of an input that is not known."""
    return Cause(message=f"{what} is not known", where=where, kind=kind, because=Cause(message=reason, where=where))
