"""Simulated digital inputs: they keep the values that somebody sets in the place of sensors."""

from __future__ import annotations

from engine.errors import RobotError


class SimInputPort:
    """Implements `robots.port.InputPort`; all inputs start off.

    Args:
        arm: Name of the arm.
        count: Number of inputs.
    """

    problem = ""

    def __init__(self, arm: str, *, count: int) -> None:
        self._arm = arm
        self._values = [False] * count

    @property
    def count(self) -> int:
        """How many there are."""
        return len(self._values)

    @property
    def values(self) -> tuple[bool, ...]:
        """Present values."""
        return tuple(self._values)

    def simulate(self, number: int, *, on: bool) -> None:
        """Turn an input on or off; raises RobotError for an unknown number."""
        if not 0 <= number < self.count:
            hint = f"its inputs are 0 to {self.count - 1}"
            raise RobotError(f"there is no input {number}", where=self._arm, hint=hint)
        self._values[number] = on

    def begin(self) -> None:
        """Turn all inputs off, for a new world."""
        self.recall((False,) * self.count)

    def recall(self, values: tuple[bool, ...]) -> None:
        """Restore the values of all inputs."""
        for number, value in enumerate(values[: self.count]):
            self._values[number] = value
