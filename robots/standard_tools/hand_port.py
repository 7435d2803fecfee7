"""The port of a simulated hand."""

from __future__ import annotations

from robots.control.commanding.motion_registry import CommandedMotion
from robots.port import HandSample
from robots.sim.grip.tool_reading import ToolReading
from robots.sim.ports.tool_ports import ToolLine

_AT_ONCE_S = 1e-3


class SimHandPort:
    """Implements `robots.port.HandPort` for a hand of a simulated world."""

    def __init__(self, line: ToolLine) -> None:
        self._line = line

    @property
    def max_force_n(self) -> float:
        """Maximum pull of the motor."""
        return self._line.tool.max_force_n

    def sample(self) -> HandSample:
        """Return the latest measurement."""
        return hand_sample(self._line.reading())

    def close_to(self, *, share: float, time_s: float) -> CommandedMotion:
        """Close or open to `share`, 0 to 1, in `time_s` or as fast as the motor can.

        Raises:
            RobotError: another motion is active, a value is invalid, or the world is lost.
        """
        line = self._line
        number = line.number()
        line.require("share", share, above_zero=False)
        line.require("time_s", time_s, above_zero=True)
        return line.start(number, (share, time_s))

    def follow(self, *, share: float) -> CommandedMotion:
        """Close or open to `share` as fast as the motor can; a motion that is active goes there instead.

        This is how the firmware of a hand follows a reference that moves.

        Raises:
            RobotError: the value is invalid, or the world is lost.
        """
        self._line.require("share", share, above_zero=False)
        return self._line.lead((share, _AT_ONCE_S))


def hand_sample(reading: ToolReading) -> HandSample:
    """Return a measurement of a hand: its values are closed share and pull."""
    closed, pull_n, _ = reading.values
    return HandSample(time_s=reading.time_s, closed_share=closed, force_n=pull_n, contacts=reading.contacts)
