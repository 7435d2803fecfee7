"""The port of a simulated magnet."""

from __future__ import annotations

from robots.control.commanding.motion_registry import CommandedMotion
from robots.magnet.magnet_port import MagnetSample
from robots.sim.grip.tool_reading import ToolReading
from robots.sim.ports.tool_ports import ToolLine


class SimMagnetPort:
    """Implements `MagnetPort` for a magnet of a simulated world."""

    def __init__(self, line: ToolLine) -> None:
        self._line = line

    @property
    def max_force_n(self) -> float:
        """Pull on a plate that covers its face."""
        return self._line.tool.max_force_n

    def sample(self) -> MagnetSample:
        """Return the latest measurement."""
        return magnet_sample(self._line.reading())

    def switch(self, *, on: bool) -> CommandedMotion:
        """Switch the field.

        Raises:
            RobotError: another switch is active, or the world is lost.
        """
        line = self._line
        return line.start(line.number(), (float(on),))


def magnet_sample(reading: ToolReading) -> MagnetSample:
    """Return a measurement of a magnet: its values are on (1 or 0) and pull."""
    (on, pull_n, _), (contact,) = reading.values, reading.contacts
    return MagnetSample(time_s=reading.time_s, on=on > 0.0, pull_n=pull_n, contact=contact)
