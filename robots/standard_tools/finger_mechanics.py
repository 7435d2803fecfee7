"""Two fingers, sliding or on a linkage, driven by a finger servo."""

from __future__ import annotations

from typing import Protocol

import numpy as np

from robots.control.motion_event import AnyMotionEvent
from robots.control.tool_drives.finger_servo import FingerCommand, FingerServo
from robots.port import Array
from robots.sim.physics.contacts import ContactReader
from robots.sim.physics.physics import Physics
from robots.standard_tools.finger_body import FingerIndices, LinkageIndices


class Gear(Protocol):
    """The transmission between the motors of a gripper and the opening between its pads."""

    def opening(self) -> tuple[float, float]:
        """Return the present opening, metres, and its rate."""
        ...

    def press(self, force_n: float) -> None:
        """Set the motors so that each pad presses outward with `force_n`, as far as the fingers' weight lets it.

        The drive of a real tool does not know how it is held and compensates no weight: 0.15 N of a Panda's finger.
        """
        ...

    def closing_axis(self) -> Array | None:
        """Return the direction from the left to the right pad in the world, None for the y axis of each pad."""
        ...


class SlidingGear:
    """A parallel gripper: one motor per finger, both with the same force."""

    def __init__(self, indices: FingerIndices, physics: Physics) -> None:
        self._indices = indices
        self._physics = physics

    def opening(self) -> tuple[float, float]:
        """Return the sum of the fingers' travels."""
        indices, physics = self._indices, self._physics
        positions, speeds = physics.positions[indices.qpos], physics.velocities[indices.dof]
        return float(np.add.reduce(positions)), float(np.add.reduce(speeds))

    def press(self, force_n: float) -> None:
        """Set both motors."""
        indices, physics = self._indices, self._physics
        physics.motors[indices.motor] = force_n

    def closing_axis(self) -> Array | None:
        """Return the pads of a parallel gripper, which face along y."""
        return None


class TurningGear:
    """A linkage or claw: one motor turns, the opening follows its angle; force at the pads becomes torque."""

    def __init__(self, indices: LinkageIndices, physics: Physics) -> None:
        self._indices = indices
        self._physics = physics

    @property
    def finger_kg(self) -> float:
        """Equivalent mass of each finger, moving half of the opening, with the kinetic energy of the motor."""
        model = self._indices.model
        travel_m_rad = model.max_width_m / abs(model.closed_rad - model.open_rad)
        return 2.0 * model.armature_kg_m2 / travel_m_rad**2

    def opening(self) -> tuple[float, float]:
        """Return the opening at the motor's angle."""
        width_m, travel_m_rad = self._at()
        return width_m, travel_m_rad * float(self._physics.velocities[self._indices.dof[0]])

    def press(self, force_n: float) -> None:
        """Set the torque that does the same work as the pad forces."""
        indices, physics = self._indices, self._physics
        _, travel_m_rad = self._at()
        physics.motors[indices.motor] = force_n * travel_m_rad

    def closing_axis(self) -> Array | None:
        """Return the pads on a linkage, which face each other."""
        left, right = self._indices.pad_geoms
        across = self._physics.geom_position(right) - self._physics.geom_position(left)
        return across / np.linalg.norm(across)

    def _at(self) -> tuple[float, float]:
        return self._indices.openings.at(float(self._physics.positions[self._indices.qpos[0]]))


class FingerMechanics:
    """Implements `ToolMechanics`: a finger servo on a gear, and the pad contacts."""

    def __init__(self, gear: Gear, servo: FingerServo, contacts: ContactReader, pads: tuple[int, int]) -> None:
        self.drive = servo
        self._gear = gear
        self._contacts = contacts
        self._pads = pads
        servo.initialize(gear.opening()[0])

    def begin(self, motion: int, goal: tuple[float, ...]) -> None:
        """Start towards an opening; `goal` is opening, speed and force."""
        width_m, speed_m_s, force_n = goal
        now_m = self._gear.opening()[0]
        self.drive.close_to(motion, width_m=width_m, speed_m_s=speed_m_s, force_n=force_n, now_m=now_m)

    def step(self, step_s: float) -> tuple[AnyMotionEvent, ...]:
        """Press with the servo's force."""
        width_m, velocity_m_s = self._gear.opening()
        events = self.drive.step(step_s, width_m=width_m, velocity_m_s=velocity_m_s)
        self._gear.press(self.drive.force_n)
        return events

    def measured(self) -> tuple[float, ...]:
        """Return progress, width, velocity, force and the pad contacts."""
        width_m, velocity_m_s = self._gear.opening()
        left, right = self._contacts.pads(self._pads, axis=self._gear.closing_axis())
        force_n = (left.force_n + right.force_n) / 2.0
        return self.drive.progress(width_m), max(width_m, 0.0), velocity_m_s, force_n, left.body, right.body

    def command(self) -> tuple[float, ...]:
        """Return set point, target, speed, force."""
        command = self.drive.command
        return command.set_m, command.target_m, command.speed_m_s, command.force_n

    def take_over(self, command: tuple[float, ...]) -> None:
        """Resume from these values."""
        set_m, target_m, speed_m_s, force_n = command
        self.drive.take_over(FingerCommand(set_m=set_m, target_m=target_m, speed_m_s=speed_m_s, force_n=force_n))
