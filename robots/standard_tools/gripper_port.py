"""The port of a simulated gripper."""

from __future__ import annotations

from robots.control.commanding.motion_registry import CommandedMotion
from robots.port import GripperSample
from robots.sim.grip.tool_reading import ToolReading
from robots.sim.ports.tool_ports import ToolLine


class SimGripperPort:
    """Implements `robots.port.GripperPort` for a gripper of a simulated world."""

    def __init__(self, line: ToolLine) -> None:
        self._line = line

    @property
    def max_width_m(self) -> float:
        """Opening when fully open."""
        return self._line.tool.max_width_m

    @property
    def max_force_n(self) -> float:
        """Maximum grip force."""
        return self._line.tool.max_force_n

    def sample(self) -> GripperSample:
        """Return the latest measurement."""
        return gripper_sample(self._line.reading())

    def close_to(self, *, width_m: float, speed_m_s: float, force_n: float) -> CommandedMotion:
        """Move the fingers towards `width_m`, pressing with at most `force_n`.

        Raises:
            RobotError: another motion is active, a value is invalid, or the world is lost.
        """
        line = self._line
        number = line.number()
        line.require("width_m", width_m, above_zero=False)
        line.require("speed_m_s", speed_m_s, above_zero=True)
        line.require("force_n", force_n, above_zero=True)
        return line.start(number, (width_m, speed_m_s, force_n))


def gripper_sample(reading: ToolReading) -> GripperSample:
    """Return a measurement of a gripper: its values are opening, velocity and force."""
    (width_m, velocity_m_s, force_n), (left, right) = reading.values, reading.contacts
    return GripperSample(
        time_s=reading.time_s, width_m=width_m, velocity_m_s=velocity_m_s, force_n=force_n, contacts=(left, right)
    )
