"""Draws whose hand gets where, when and how fast into the path of an arm that moves, and what could avoid a contact."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, Literal

import numpy as np

from engine.messages import Vector3
from robots.port import Array
from robots.scene.sim_scene import PersonBody
from robots.sim.people.hand_trajectory import HandMotion, plan_hand_trajectory
from robots.sim.physics.cell_model import CellModel
from robots.sim.physics.limb import Limb, LimbPose
from robots.sim.physics.person_spec import PersonIndices
from robots.sim.physics.physics import mujoco

STEP_S = 0.05
"""How finely paths of arm and person are compared."""

SEEN_M = 0.06
"""Nearer than this to the rest of the path, a person is in the way: the margin of the motion and two voxels' halves."""

CLEAR_M = 0.05
"""What the person must keep from where the arm still gets by itself."""

_SPREAD_M = 0.06
_TRIES = 5000

Avoidability = Literal["stopping", "slower", "nothing"]
"""What avoids a contact of an arm that notices the person at once.

`stopping`: braking within the reaction and braking time is enough. `slower`: the arm gets to the person within that
time, but is not there yet when the person comes into its path, so that a slower one would have come to rest before
(ISO 13855: the person is within the minimum distance). `nothing`: the person moves to where the arm already is, and
would touch one at rest.
"""


@dataclass(frozen=True, kw_only=True)
class UndisturbedMotion:
    """A motion that nobody disturbed: `joints` (m, n) every `STEP_S` from its start to its end."""

    start: tuple[float, ...]
    goal: tuple[float, ...]
    joints: Array

    @property
    def duration_s(self) -> float:
        """How long it took."""
        return (len(self.joints) - 1) * STEP_S


@dataclass(frozen=True, kw_only=True)
class Intrusion:
    """`after_s` the start of the motion the hand of `person` leaves for `hand_m`; with `stay_s` None it stays there.

    `near` is the body of the arm whose path the place was drawn at. Nobody reacting, the person would be in the
    path of the rest of the motion `noticeable_s` after its start. A contact is avoided by `avoidable_by`.
    """

    person: str
    after_s: float
    hand_m: Vector3
    speed_m_s: float
    stay_s: float | None
    near: str
    noticeable_s: float
    avoidable_by: Avoidability


@dataclass(frozen=True, kw_only=True)
class _Reacher:
    """A person in the model."""

    person: PersonBody
    limb: Limb
    indices: PersonIndices
    geoms: list[int]


class IntrusionDrawer:
    """Draws intrusions into recorded paths of one arm of a cell, and says of each what could avoid a contact.

    Args:
        cell: The cell.
        stopping_s: Reaction and braking time of the arm.
    """

    def __init__(self, cell: CellModel, *, stopping_s: float) -> None:
        self._model, self._data = cell.model, mujoco.MjData(cell.model)
        (self._arm,) = cell.arms
        self._people = [
            _Reacher(person=person, limb=Limb(person), indices=indices, geoms=self._geoms(frozenset(indices.bodies)))
            for person, indices in zip(cell.scene.people, cell.people, strict=True)
        ]
        self._stopping_s = stopping_s
        self._arm_geoms = self._geoms(self._arm.bodies)
        self._rbound: Array = cell.model.geom_rbound
        self._names = cell.body_names
        self.drawn = 0
        """Places drawn that are in reach."""
        self.beside = 0
        """Of these, hands that do not get into the path, which are no intrusions."""

    def draw(self, motion: UndisturbedMotion, random: np.random.Generator) -> Intrusion:
        """Return an intrusion into a path.

        Raises:
            ValueError: nobody reaches anything of it.
        """
        for _ in range(_TRIES):
            found = self._tried(motion, random)
            if found is not None:
                return found
        raise ValueError("nobody gets into this path; let a shoulder stand nearer to it")

    def _tried(self, motion: UndisturbedMotion, random: np.random.Generator) -> Intrusion | None:
        after_s = float(random.uniform(0.0, 0.9 * motion.duration_s))
        ahead_s = float(random.uniform(after_s, motion.duration_s))
        speed_m_s = float(random.uniform(0.25, 1.2))
        stay_s = None if random.random() < 0.3 else float(random.uniform(0.3, 3.0))
        who = self._people[int(random.integers(len(self._people)))]
        body = int(random.choice(sorted(self._arm.bodies)))
        place = self._body_at(motion.joints[round(ahead_s / STEP_S)], body) + random.normal(0.0, _SPREAD_M, 3)
        least_m, greatest_m = who.person.reach_m
        if not least_m <= who.limb.away_m(place) <= greatest_m:
            return None
        poses = _reaching(who, place, speed_m_s)
        if poses is None:
            return None
        self.drawn += 1
        # The last pose decides most; the whole reach is looked at where it lets that pass.
        is_in_path = self._nearer(who, poses[-1], motion.joints[round(after_s / STEP_S) :], than_m=SEEN_M)
        noticeable_s = self._noticeable_s(who, motion, poses, after_s) if is_in_path else None
        if noticeable_s is None:
            self.beside += 1
            return None
        x, y, z = place.tolist()
        return Intrusion(
            person=who.person.name,
            after_s=after_s,
            hand_m=(x, y, z),
            speed_m_s=speed_m_s,
            stay_s=stay_s,
            near=self._names[body],
            noticeable_s=noticeable_s,
            avoidable_by=self._avoidable_by(who, motion, poses, from_s=after_s, noticeable_s=noticeable_s),
        )

    def _avoidable_by(
        self, who: _Reacher, motion: UndisturbedMotion, poses: Sequence[LimbPose], *, from_s: float, noticeable_s: float
    ) -> Avoidability:
        rows, first, noticed = motion.joints, round(from_s / STEP_S), round(noticeable_s / STEP_S)
        last = min(noticed, len(rows) - 1)
        # Until then nobody could know of the person; an arm that is at rest from then on could not do more. Both move
        # by more than the margin within a step, so the arm is looked at a step earlier and later too.
        at = [min(first + k, last) for k in range(len(poses))]
        if any(
            self._nearer(who, pose, rows[max(row - 1, 0) : row + 2], than_m=CLEAR_M)
            for pose, row in zip(poses, at, strict=True)
        ):
            return "nothing"
        braking = rows[last : round((noticeable_s + self._stopping_s) / STEP_S) + 1]
        if any(self._nearer(who, pose, braking, than_m=CLEAR_M) for pose in poses[noticed - first :]):
            return "slower"
        return "stopping"

    def _noticeable_s(
        self, who: _Reacher, motion: UndisturbedMotion, poses: Sequence[LimbPose], after_s: float
    ) -> float | None:
        """Return when the person is first in the rest of the path, None for never."""
        for k, pose in enumerate(poses):
            at_s = after_s + k * STEP_S
            rest = motion.joints[min(round(at_s / STEP_S), len(motion.joints) - 1) :]
            if self._nearer(who, pose, rest, than_m=SEEN_M):
                return at_s
        return None

    def _nearer(self, who: _Reacher, pose: LimbPose, rows: Array, *, than_m: float) -> bool:
        self._data.qpos[who.indices.qpos] = np.hstack((pose.xyz, pose.wxyz)).reshape(-1)
        return any(self._at_distance(who, row, than_m) for row in rows)

    def _at_distance(self, who: _Reacher, joints: Array, than_m: float) -> bool:
        """Return whether person and arm are nearer than that."""
        model, data = self._model, self._data
        data.qpos[self._arm.qpos] = joints
        mujoco.mj_kinematics(model, data)
        own, other = who.geoms, self._arm_geoms
        apart = np.linalg.norm(data.geom_xpos[own][:, None] - data.geom_xpos[other][None], axis=2)
        near = np.argwhere(apart < self._rbound[own][:, None] + self._rbound[other][None] + than_m)
        return any(
            mujoco.mj_geomDistance(model, data, own[i], other[j], than_m, None) < than_m for i, j in near.tolist()
        )

    def _body_at(self, joints: Array, body: int) -> Array:
        self._data.qpos[self._arm.qpos] = joints
        mujoco.mj_kinematics(self._model, self._data)
        return np.array(self._data.xpos[body])

    def _geoms(self, bodies: frozenset[int]) -> list[int]:
        model: Any = self._model
        return [
            geom
            for geom in range(model.ngeom)
            if int(model.geom_bodyid[geom]) in bodies and (model.geom_contype[geom] or model.geom_conaffinity[geom])
        ]


def _reaching(who: _Reacher, place: Array, speed_m_s: float) -> list[LimbPose] | None:
    """Return a person every `STEP_S` of a reach; None where it would lead through the shoulder, there or back."""
    rest, limb = np.array(who.person.hand_rests), who.limb
    trajectory = plan_hand_trajectory(HandMotion(xyz=rest, velocity=np.zeros(3)), place, speed_m_s=speed_m_s)
    if any(limb.away_m(at) < who.person.reach_m[0] for at in trajectory.places()):
        return None
    side = limb.hanging(rest)
    poses: list[LimbPose] = []
    for k in range(int(np.ceil(trajectory.duration_s / STEP_S)) + 1):
        hand = trajectory.at(k * STEP_S).xyz
        side = limb.carried_on(side, hand, step_s=STEP_S)
        poses.append(limb.pose(hand, side))
    return poses
