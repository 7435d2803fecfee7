"""The link to the control loop of an arm in a world."""

from __future__ import annotations

from robots.control.commanding.arm_commands import ArmCommand, MotionCommand
from robots.port import ArmSample
from robots.sim.host.world_host import WorldHost


class WorldArmLink:
    """Implements `robots.control.commanding.commanded_arm_port.ControlLink` on either host."""

    def __init__(self, host: WorldHost, arm: str) -> None:
        self._host = host
        self._arm = arm

    def send(self, command: ArmCommand | MotionCommand) -> None:
        """Send a command to the world."""
        self._host.send(command)

    def sample(self) -> ArmSample:
        """Return the latest measurement."""
        return self._host.snapshot().arm(self._arm)

    def progress(self, motion: int) -> float | None:
        """Return the progress of a motion; None if the arm does not execute this motion."""
        return self._host.snapshot().arm_progress(self._arm, motion)
