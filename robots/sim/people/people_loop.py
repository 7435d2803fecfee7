"""The people of a simulation: moves their bodies before each step and counts their contacts after it."""

from __future__ import annotations

import numpy as np

from engine.skills.people import Reach
from robots.port import Array
from robots.sim.people.contact_counter import ContactCounter
from robots.sim.people.person_motion import MOTION_FIELDS, PersonMotion
from robots.sim.people.person_report import report_size
from robots.sim.physics.cell_model import CellModel
from robots.sim.physics.limb import LimbPose
from robots.sim.physics.person_spec import PersonIndices
from robots.sim.physics.physics import Physics


class PeopleLoop:
    """Steps all people of a world. In contacts their bodies have the velocity of their motion."""

    def __init__(self, cell: CellModel, physics: Physics, *, step_s: float) -> None:
        self._physics = physics
        self._step_s = step_s
        self._indices = cell.people
        self._people = [PersonMotion(person, step_s=step_s) for person in cell.scene.people]
        self._by_name = {person.name: row for row, person in enumerate(cell.people)}
        self._qpos = [_positions(person.pose) for person in self._people]
        self._qvel = [np.zeros(6 * len(person.bodies)) for person in cell.people]
        body_count = len(cell.body_names)
        self._counter = ContactCounter(cell.people, physics, body_count=body_count) if cell.people else None
        self.report_size = report_size(len(cell.people), body_count=body_count)
        count_size = self._counter.numbers.size if self._counter is not None else 0
        self.image_size = MOTION_FIELDS * len(cell.people) + count_size

    def send(self, request: Reach) -> None:
        """Send a hand to a point."""
        self._people[self._by_name[request.person]].send(request)

    def place(self) -> None:
        """Set poses and velocities of the bodies for the next step."""
        for person, indices, qpos, qvel in zip(self._people, self._indices, self._qpos, self._qvel, strict=True):
            before = person.pose
            if person.step():
                qpos[:] = _positions(before)
                qvel[:] = _velocities(before, person.pose, self._step_s)
            self._put(indices, qpos, qvel)

    def count(self) -> None:
        """Count the contacts of the step just done."""
        if self._counter is not None:
            self._counter.step(self._step_s)

    def write_report(self, values: Array) -> None:
        """Write the report for `robots.sim.people.person_report`, (`report_size`,)."""
        if self._counter is None:
            return
        for person, row, numbers in zip(
            self._people, values.reshape(len(self._people), -1), self._counter.numbers, strict=True
        ):
            hand = person.hand
            row[0:3], row[3:6], row[6] = hand.xyz, hand.velocity, person.arrives_in_s
            row[7:] = numbers

    def write_image(self, image: Array) -> None:
        """Write the complete state of people and contact statistics, (`image_size`,)."""
        if self._counter is None:
            return
        motions = image[: MOTION_FIELDS * len(self._people)].reshape(-1, MOTION_FIELDS)
        for person, numbers in zip(self._people, motions, strict=True):
            person.write(numbers)
        image[motions.size :] = self._counter.numbers.reshape(-1)

    def take_over(self, image: Array) -> None:
        """Continue from an image."""
        if self._counter is None:
            return
        motions = image[: MOTION_FIELDS * len(self._people)].reshape(-1, MOTION_FIELDS)
        for person, numbers, qpos, qvel in zip(self._people, motions, self._qpos, self._qvel, strict=True):
            person.take_over(numbers)
            qpos[:] = _positions(person.pose)
            qvel[:] = 0.0
        self._counter.take_over(image[motions.size :].reshape(self._counter.numbers.shape))

    def _put(self, indices: PersonIndices, qpos: Array, qvel: Array) -> None:
        self._physics.positions[indices.qpos] = qpos
        self._physics.velocities[indices.dof] = qvel


def _positions(pose: LimbPose) -> Array:
    return np.hstack((pose.xyz, pose.wxyz)).reshape(-1)


def _velocities(before: LimbPose, after: LimbPose, step_s: float) -> Array:
    """Return the velocities, (18,), between two poses: linear of the origin in the world, angular in the body frame."""
    b, a = before.wxyz, after.wxyz
    # conjugate(b) * a, vector part; over one step the rotation is twice that, along the shorter arc.
    scalar = (b * a).sum(axis=1)
    crossed = b[:, [2, 3, 1]] * a[:, [3, 1, 2]] - b[:, [3, 1, 2]] * a[:, [2, 3, 1]]
    turn = b[:, :1] * a[:, 1:] - a[:, :1] * b[:, 1:] - crossed
    turn *= np.where(scalar < 0.0, -2.0, 2.0)[:, None]
    return np.hstack((after.xyz - before.xyz, turn)).reshape(-1) / step_s
