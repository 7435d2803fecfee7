"""The motion of one person's arm: rest, reach, stay for a while, return."""

from __future__ import annotations

import numpy as np

from engine.skills.people import Reach
from robots.port import Array
from robots.scene.sim_scene import PersonBody
from robots.sim.people.hand_trajectory import HandMotion, HandTrajectory, plan_hand_trajectory
from robots.sim.physics.limb import Limb, LimbPose

MOTION_FIELDS = 16
"""Length of the complete state of a person's motion."""

_FOR_EVER = -1.0


class PersonMotion:
    """The hand moves to its last goal and the bodies follow. Contacts push the arm off this motion, see `Yielding`."""

    def __init__(self, person: PersonBody, *, step_s: float) -> None:
        self._rest = np.array(person.hand_rests)
        self._limb = Limb(person)
        self._step_s = step_s
        self._trajectory = HandTrajectory(start=_at_rest(self._rest), goal=self._rest, duration_s=0.0)
        self._steps = 0
        self._stay_s = _FOR_EVER
        self._speed_m_s = 1.0
        self._side = self._limb.hanging(self._rest)
        self._still = False
        self.pose: LimbPose = self._limb.pose(self._rest, self._side)

    @property
    def hand(self) -> HandMotion:
        """Position and velocity of the hand."""
        return self._trajectory.at(self._steps * self._step_s)

    @property
    def arrives_in_s(self) -> float:
        """Remaining motion time of the hand, 0 at its goal."""
        return max(0.0, self._trajectory.duration_s - self._steps * self._step_s)

    def send(self, request: Reach) -> None:
        """Send the hand to a point; replaces its present motion."""
        self._go(np.array(request.hand_m), speed_m_s=request.speed_m_s)
        self._stay_s = _FOR_EVER if request.stay_s is None else request.stay_s

    def step(self) -> bool:
        """Simulate one step; returns False if nothing moved."""
        if self._still:
            return False
        self._steps += 1
        if self._stay_s >= 0.0 and self._steps * self._step_s >= self._trajectory.duration_s + self._stay_s:
            self._go(self._rest, speed_m_s=self._speed_m_s)
            self._stay_s = _FOR_EVER
        hand = self._trajectory.place(self._steps * self._step_s)
        side = self._limb.carried_on(self._side, hand, step_s=self._step_s)
        before, self._side = self.pose, side
        self.pose = self._limb.pose(hand, side)
        there_for_ever = self.arrives_in_s == 0.0 and self._stay_s < 0.0
        self._still = there_for_ever and np.array_equal(before.xyz, self.pose.xyz)
        return True

    def write(self, out: Array) -> None:
        """Write the complete state of the motion, shape (`MOTION_FIELDS`,)."""
        trajectory = self._trajectory
        out[0:3], out[3:6], out[6:9] = trajectory.start.xyz, trajectory.start.velocity, trajectory.goal
        out[9:13] = trajectory.duration_s, self._steps, self._stay_s, self._speed_m_s
        out[13:16] = self._side

    def take_over(self, numbers: Array) -> None:
        """Continue from the numbers of `write`."""
        start = HandMotion(xyz=numbers[0:3].copy(), velocity=numbers[3:6].copy())
        self._trajectory = HandTrajectory(start=start, goal=numbers[6:9].copy(), duration_s=float(numbers[9]))
        self._steps = int(numbers[10])
        self._stay_s, self._speed_m_s = float(numbers[11]), float(numbers[12])
        self._side = numbers[13:16].copy()
        self._still = False
        self.pose = self._limb.pose(self.hand.xyz, self._side)

    def _go(self, goal: Array, *, speed_m_s: float) -> None:
        self._trajectory = plan_hand_trajectory(self.hand, goal, speed_m_s=speed_m_s)
        self._steps = 0
        self._speed_m_s = speed_m_s
        self._still = False


def _at_rest(xyz: Array) -> HandMotion:
    return HandMotion(xyz=xyz, velocity=np.zeros(3))
