"""The digital outputs of a robot's controller, simulated or real."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Protocol, runtime_checkable


class OutputPort(Protocol):
    """Outputs numbered from 0; they keep their values until set again."""

    @property
    def values(self) -> tuple[bool, ...]:
        """Present values."""
        ...

    def set(self, output: int, *, on: bool) -> None:
        """Turn an output on or off.

        Raises:
            RobotError: there is no such output, or the device is lost.
        """
        ...


class SwitchableOutputs(Protocol):
    """The outputs of a device of the cell, as tools at them use them."""

    @property
    def values(self) -> tuple[bool, ...]:
        """Present values."""
        ...

    async def switch(self, output: int, *, on: bool) -> None:
        """Turn an output on or off and return when it is, as far as the device confirms it; raises RobotError."""
        ...


@runtime_checkable
class NamedOutputs(Protocol):
    """Outputs whose names stay while their numbers may change: those of equipment."""

    @property
    def names(self) -> Mapping[str, int]:
        """The present number of each output by name."""
        ...


@runtime_checkable
class OutputOwner(Protocol):
    """A device of the cell that may have digital outputs."""

    @property
    def outputs(self) -> SwitchableOutputs | None:
        """Its outputs; None without any, or while it is not connected."""
        ...


@runtime_checkable
class ConfirmedOutputs(Protocol):
    """Outputs that are read back from a real controller."""

    async def confirmed(self) -> None:
        """Return when the controller reads back what was set.

        Raises:
            RobotError: it reads something else, or the device is lost.
        """
        ...
