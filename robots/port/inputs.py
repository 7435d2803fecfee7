"""The digital inputs of a robot's controller, simulated or real."""

from __future__ import annotations

from typing import Protocol


class InputPort(Protocol):
    """Inputs numbered from 0."""

    @property
    def count(self) -> int:
        """How many there are."""
        ...

    @property
    def values(self) -> tuple[bool, ...]:
        """Present values; none while `problem` says why."""
        ...

    @property
    def problem(self) -> str:
        """Why nothing is known of them at present; empty if they are measured."""
        ...
