"""A soft hand in a simulated world: one motor pulls the tendon that runs over all its joints."""

from __future__ import annotations

from robots.control.motion_event import AnyMotionEvent
from robots.control.tool_drives.tendon_servo import TendonCommand, TendonServo
from robots.sim.physics.contacts import ContactReader
from robots.sim.physics.physics import Physics
from robots.standard_tools.hand_body import HandIndices


class SoftHandMechanics:
    """Blocked fingers stop while the others continue to close: the tendon slides to where it is slack."""

    def __init__(self, indices: HandIndices, physics: Physics, contacts: ContactReader, *, own: frozenset[int]) -> None:
        self._indices = indices
        self._physics = physics
        self._contacts = contacts
        self._own = own
        model = indices.model
        self.drive = TendonServo(
            travel_m=model.travel_m, max_speed_m_s=model.travel_speed_m_s, max_force_n=model.max_force_n
        )
        # The pull of a free tendon turns each joint until its spring balances it: the springs act in series.
        self._give_m_n = sum(joint.radius_m**2 / joint.stiffness_nm_rad for joint in model.flexion)

    def begin(self, motion: int, goal: tuple[float, ...]) -> None:
        """Start closing; `goal` is the share, 0 open to 1, and the time."""
        share, time_s = goal
        self.drive.close_to(motion, share=share, time_s=time_s)

    def step(self, step_s: float) -> tuple[AnyMotionEvent, ...]:
        """Pull."""
        pulled_m, velocity_m_s = self._physics.tendon(self._indices.tendon)
        events = self.drive.step(step_s, pulled_m=pulled_m, velocity_m_s=velocity_m_s)
        self._physics.motors[self._indices.motor] = self.drive.force_n
        return events

    def measured(self) -> tuple[float, ...]:
        """Return progress, closed share, pull beyond that of the springs, nothing, contacts of fingers and palm."""
        touched = self._contacts.touched(self._indices.places, own=self._own)
        pulled_m, _ = self._physics.tendon(self._indices.tendon)
        pressing_n = max(0.0, self.drive.force_n - pulled_m / self._give_m_n)
        return (self.drive.progress, self.drive.closed_share, pressing_n, 0.0, *touched)

    def command(self) -> tuple[float, ...]:
        """Return wound-up length, target, speed."""
        command = self.drive.command
        return command.wound_m, command.target_m, command.speed_m_s

    def take_over(self, command: tuple[float, ...]) -> None:
        """Resume from these values."""
        wound_m, target_m, speed_m_s = command[:3]
        self.drive.take_over(TendonCommand(wound_m=wound_m, target_m=target_m, speed_m_s=speed_m_s))
