"""The people of a simulation: moves their bodies before each step and counts their contacts after it."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from engine.skills.people import Reach
from robots.port import Array
from robots.sim.people.contact_counter import ContactCounter
from robots.sim.people.limb_yielding import NO_PUSH_M_S, YIELDING_FIELDS, Yielding
from robots.sim.people.person_motion import MOTION_FIELDS, PersonMotion
from robots.sim.people.person_report import report_size
from robots.sim.physics.cell_model import CellModel
from robots.sim.physics.limb import LimbPose
from robots.sim.physics.physics import Physics

_FIELDS = MOTION_FIELDS + YIELDING_FIELDS


class PeopleLoop:
    """Steps all people of a world. Contacts push their arms off their motions, see `Yielding`."""

    def __init__(self, cell: CellModel, physics: Physics, *, step_s: float) -> None:
        self._physics = physics
        self._step_s = step_s
        self._indices = cell.people
        self._people = [PersonMotion(person, step_s=step_s) for person in cell.scene.people]
        self._by_name = {person.name: row for row, person in enumerate(cell.people)}
        if self._people:
            # It loads numba, and most cells have no people.
            from robots.sim.physics import limb_kernels

            self._move = limb_kernels.move
        self._all_qpos = _joined([indices.qpos for indices in cell.people])
        self._all_dof = _joined([indices.dof for indices in cell.people])
        # Those of all people, and the rows of each.
        self._together_qpos, self._together_qvel = np.zeros(len(self._all_qpos)), np.zeros(len(self._all_dof))
        self._together_placed = np.zeros(len(self._all_dof))
        count = max(1, len(cell.people))
        self._qpos = list(self._together_qpos.reshape(count, -1))
        self._qvel = list(self._together_qvel.reshape(count, -1))
        self._placed = list(self._together_placed.reshape(count, -1))
        for person, qpos in zip(self._people, self._qpos, strict=False):
            qpos[:] = _positions(person.pose)
        self._yielding = [Yielding() for _ in cell.people]
        body_count = len(cell.body_names)
        self._counter = _counter(cell, physics)
        self.report_size = report_size(len(cell.people), body_count=body_count)
        count_size = self._counter.numbers.size if self._counter is not None else 0
        self.image_size = _FIELDS * len(cell.people) + count_size

    def send(self, request: Reach) -> None:
        """Send a hand to a point."""
        self._people[self._by_name[request.person]].send(request)

    def place(self) -> None:
        """Set poses and velocities of the bodies for the next step."""
        for row, person in enumerate(self._people):
            before, qpos, qvel = person.pose, self._qpos[row], self._qvel[row]
            if person.step():
                after = person.pose
                self._move(before.xyz, before.wxyz, after.xyz, after.wxyz, self._step_s, qpos, qvel)
        if any(yielding.active for yielding in self._yielding):
            for row in range(len(self._people)):
                self._put(row)
        elif self._people:
            self._together_placed[:] = self._together_qvel
            self._physics.positions[self._all_qpos] = self._together_qpos
            self._physics.velocities[self._all_dof] = self._together_qvel

    def count(self) -> None:
        """Count the contacts of the step just done, and let them push."""
        if self._counter is None:
            return
        self._counter.step(self._step_s)
        pushed = self._physics.velocities[self._all_dof] - self._together_placed
        linear = pushed.reshape(len(self._people), -1, 6)[:, :, :3]
        if np.abs(linear).max() < NO_PUSH_M_S / 10.0 and not any(one.active for one in self._yielding):
            return
        for row, yielding in zip(linear, self._yielding, strict=True):
            yielding.step(row, step_s=self._step_s)

    def write_report(self, values: Array) -> None:
        """Write the report for `robots.sim.people.person_report`, (`report_size`,)."""
        if self._counter is None:
            return
        rows = values.reshape(len(self._people), -1)
        for person, yielding, row, numbers in zip(
            self._people, self._yielding, rows, self._counter.numbers, strict=True
        ):
            hand = person.hand
            row[0:3], row[3:6] = hand.xyz + yielding.offset, hand.velocity + yielding.velocity
            row[6] = person.arrives_in_s
            row[7:] = numbers

    def write_image(self, image: Array) -> None:
        """Write the complete state of people and contact statistics, (`image_size`,)."""
        if self._counter is None:
            return
        motions = image[: _FIELDS * len(self._people)].reshape(-1, _FIELDS)
        for person, yielding, numbers in zip(self._people, self._yielding, motions, strict=True):
            person.write(numbers[:MOTION_FIELDS])
            yielding.write(numbers[MOTION_FIELDS:])
        image[motions.size :] = self._counter.numbers.reshape(-1)

    def take_over(self, image: Array) -> None:
        """Continue from an image."""
        if self._counter is None:
            return
        motions = image[: _FIELDS * len(self._people)].reshape(-1, _FIELDS)
        for person, yielding, numbers, qpos, qvel in zip(
            self._people, self._yielding, motions, self._qpos, self._qvel, strict=True
        ):
            person.take_over(numbers[:MOTION_FIELDS])
            yielding.take_over(numbers[MOTION_FIELDS:])
            qpos[:] = _positions(person.pose)
            qvel[:] = 0.0
        self._counter.take_over(image[motions.size :].reshape(self._counter.numbers.shape))

    def _put(self, row: int) -> None:
        indices, yielding, placed = self._indices[row], self._yielding[row], self._placed[row]
        qpos, placed[:] = self._qpos[row], self._qvel[row]
        if yielding.active:
            qpos = qpos.copy()
            qpos.reshape(-1, 7)[:, :3] += yielding.offset
            placed.reshape(-1, 6)[:, :3] += yielding.velocity
        self._physics.positions[indices.qpos] = qpos
        self._physics.velocities[indices.dof] = placed


def _counter(cell: CellModel, physics: Physics) -> ContactCounter | None:
    if not cell.people:
        return None
    fixtures = {fixture.name for fixture in (*cell.scene.fixtures, *cell.scene.unknown_fixtures)}
    fixed = frozenset(number for number, name in enumerate(cell.body_names) if number == 0 or name in fixtures)
    return ContactCounter(cell.people, physics, body_count=len(cell.body_names), fixed=fixed)


def _joined(places: Sequence[NDArray[np.intp]]) -> NDArray[np.intp]:
    return np.concatenate([np.zeros(0, dtype=np.intp), *places])


def _positions(pose: LimbPose) -> Array:
    return np.hstack((pose.xyz, pose.wxyz)).reshape(-1)
