"""The digital outputs of a robot's controller, simulated or real."""

from __future__ import annotations

from typing import Protocol


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
