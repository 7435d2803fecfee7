"""Values of URScript, and the arguments of a call, read by position or by name."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from robots.drivers.universal_robots.emulator.urscript.urscript_syntax import UrscriptError
from robots.port.arrays import Array


class UrscriptList(list["UrscriptValue"]):
    """A list; `is_pose` where it was written `p[…]`. Assigning it copies it."""

    def __init__(self, items: Sequence[UrscriptValue], *, is_pose: bool = False) -> None:
        super().__init__(items)
        self.is_pose = is_pose

    def __eq__(self, other: object) -> bool:
        return isinstance(other, UrscriptList) and self.is_pose == other.is_pose and list(self) == list(other)

    __hash__ = None  # type: ignore[assignment]


UrscriptValue = bool | int | float | str | UrscriptList | None


def copied(value: UrscriptValue) -> UrscriptValue:
    """Return the value as it is assigned: lists are values and not references."""
    if isinstance(value, UrscriptList):
        return UrscriptList([copied(item) for item in value], is_pose=value.is_pose)
    return value


def pose_value(pose: Sequence[float]) -> UrscriptList:
    """Return a pose as a value."""
    return UrscriptList([float(item) for item in pose], is_pose=True)


def list_value(numbers: Sequence[float] | Array) -> UrscriptList:
    """Return a list of numbers as a value."""
    return UrscriptList([float(item) for item in numbers])


def number_of(value: UrscriptValue) -> float:
    """Return a number; raises UrscriptError."""
    if isinstance(value, bool) or not isinstance(value, (int, float)) or not math.isfinite(value):
        raise UrscriptError(f"a number is expected, not {text_of(value)}")
    return value


def six_numbers(value: UrscriptValue) -> Array:
    """Return a list or pose of six numbers; raises UrscriptError."""
    if not isinstance(value, UrscriptList) or len(value) != 6:
        raise UrscriptError(f"six numbers are expected, not {text_of(value)}")
    return np.array([number_of(item) for item in value], dtype=float)


def text_of(value: UrscriptValue) -> str:
    """Return a value as `textmsg` shows it."""
    if isinstance(value, UrscriptList):
        return ("p[" if value.is_pose else "[") + ", ".join(text_of(item) for item in value) + "]"
    return f"{value + 0.0:.6g}" if isinstance(value, float) else str(value)


@dataclass(frozen=True, slots=True)
class UrscriptArguments:
    """The arguments of one call."""

    by_position: Sequence[UrscriptValue]
    by_name: Mapping[str, UrscriptValue]

    def has(self, position: int, name: str) -> bool:
        """Whether an argument is given."""
        return position < len(self.by_position) or name in self.by_name

    def value(self, position: int, name: str) -> UrscriptValue:
        """Return an argument; raises UrscriptError where it is missing."""
        if position < len(self.by_position):
            return self.by_position[position]
        if name in self.by_name:
            return self.by_name[name]
        raise UrscriptError(f"argument `{name}` is missing")

    def number(self, position: int, name: str, default: float | None = None) -> float:
        """Return a number."""
        if default is not None and not self.has(position, name):
            return default
        return number_of(self.value(position, name))

    def integer(self, position: int, name: str) -> int:
        """Return a whole number."""
        return int(self.number(position, name))

    def index(self, position: int, name: str, count: int) -> int:
        """Return a whole number from zero below a count."""
        index = self.integer(position, name)
        if not 0 <= index < count:
            raise UrscriptError(f"`{name}` is {index}; there are {count}")
        return index

    def six(self, position: int, name: str) -> Array:
        """Return six numbers."""
        return six_numbers(self.value(position, name))

    def three(self, position: int, name: str) -> tuple[float, float, float]:
        """Return three numbers."""
        value = self.value(position, name)
        if not isinstance(value, UrscriptList) or len(value) != 3:
            raise UrscriptError(f"three numbers are expected, not {text_of(value)}")
        x, y, z = (number_of(item) for item in value)
        return x, y, z
