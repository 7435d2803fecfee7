"""Simulated digital outputs: they keep their values and notify the devices wired to them."""

from __future__ import annotations

from collections.abc import Callable

from engine.errors import RobotError


class SimOutputPort:
    """Implements `robots.port.OutputPort`; all outputs start off.

    Args:
        arm: Name of the arm.
        count: Number of outputs.
    """

    def __init__(self, arm: str, *, count: int) -> None:
        self._arm = arm
        self._values = [False] * count
        self._wires: list[tuple[int, Callable[[bool], None]]] = []

    @property
    def values(self) -> tuple[bool, ...]:
        """Present values."""
        return tuple(self._values)

    def wire(self, output: int, device: Callable[[bool], None]) -> None:
        """Call `device` with the value of an output now, and at every change."""
        self._check(output)
        self._wires.append((output, device))
        device(self._values[output])

    def set(self, output: int, *, on: bool) -> None:
        """Turn an output on or off; raises RobotError for an unknown number."""
        self._check(output)
        if self._values[output] == on:
            return
        self._values[output] = on
        for number, device in self._wires:
            if number == output:
                device(on)

    def begin(self) -> None:
        """Turn all outputs off, for a new world."""
        self.recall((False,) * len(self._values))

    def recall(self, values: tuple[bool, ...]) -> None:
        """Restore the values of all outputs."""
        for output, value in enumerate(values):
            self.set(output, on=value)

    def _check(self, output: int) -> None:
        if not 0 <= output < len(self._values):
            raise RobotError(
                f"there is no output {output}", where=self._arm, hint=f"its outputs are 0 to {len(self._values) - 1}"
            )
