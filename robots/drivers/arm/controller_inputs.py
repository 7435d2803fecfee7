"""The digital inputs of a real controller, as its readings have them."""

from __future__ import annotations

from collections.abc import Callable


class ControllerInputs:
    """Implements `robots.port.InputPort`.

    Args:
        count: Number of inputs.
        values: Returns what was read last.
        lost_reason: Returns why nothing is read; empty while it is.
    """

    def __init__(self, *, count: int, values: Callable[[], tuple[bool, ...]], lost_reason: Callable[[], str]) -> None:
        self.count = count
        self._values = values
        self._lost_reason = lost_reason

    @property
    def values(self) -> tuple[bool, ...]:
        """Present values; none while `problem` says why."""
        return () if self.problem else self._values()[: self.count]

    @property
    def problem(self) -> str:
        """Why nothing is known of them at present; empty if they are measured."""
        return self._lost_reason()
