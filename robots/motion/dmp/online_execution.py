"""Step-by-step execution of movement primitives: new goals, speed changes and phase stopping during the motion.

Phase stopping (Ude et al. 2014; Ijspeert et al. 2002): when the arm is held back by the error e, the
phase decays as tau ẋ = -a_x x / (1 + a_px e), and the state is pulled to the arm's position with the gain
`a_py`, so the motion waits and resumes when the arm is released.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from engine.messages.primitives import CartDmp, JointDmp
from robots.motion.dmp.attractor import integrate_rotation, orientation_acceleration
from robots.motion.dmp.kernels import GaussianKernels
from robots.motion.dmp.quaternions import conjugate, exp, log, product, toward
from robots.port import Array


@dataclass(frozen=True, kw_only=True)
class PhaseStopping:
    """Gains with which an error slows the phase and pulls the state; both 0 for never.

    `a_px` is per radian or metre of error, `a_py` per tau. In a pose `metres_per_rad` weighs the angle in the error.
    """

    a_px: float = 1000.0
    a_py: float = 20.0
    metres_per_rad: float = 0.1


NEVER_STOPPING = PhaseStopping(a_px=0.0, a_py=0.0)


class _OnlineDmp:
    """Base of both kinds: phase, duration and the moving goal."""

    def __init__(self, dmp: JointDmp | CartDmp, weights: Array, stopping: PhaseStopping) -> None:
        self.tau_s = dmp.tau
        self.phase = 1.0
        self._a_x, self._a_z = dmp.a_x, dmp.a_z
        self._a_g = dmp.a_z / 4.0
        self._kernels = GaussianKernels.of(dmp.c, dmp.sigma)
        self._weights = weights
        self._stopping = stopping

    @property
    def share(self) -> float:
        """Elapsed share of tau in the primitive's own time."""
        return float(-np.log(self.phase) / self._a_x)

    def _forcing(self) -> Array:
        """Return the forcing term now, (n,)."""
        return self.phase * (self._weights @ self._kernels.at(np.array([self.phase]))[0])

    def _pass(self, span: float, error: float) -> None:
        self.phase *= float(np.exp(-self._a_x * span / (1.0 + self._stopping.a_px * error)))


class OnlineJointDmp(_OnlineDmp):
    """An active joint DMP; `position` (rad) and `velocity` (rad/s) are its present state, (n,).

    Set `tau_s` at any time to change the speed. `tasktrans` is not applied, see `joints_in_task_frame`.
    """

    def __init__(self, dmp: JointDmp, *, stopping: PhaseStopping = NEVER_STOPPING) -> None:
        super().__init__(dmp, np.array(dmp.w), stopping)
        self.position = np.array(dmp.y0)
        self._rate = dmp.tau * np.array(dmp.dy0)
        self._velocity = np.array(dmp.dy0)
        self._goal = np.array(dmp.goal)
        self._final_goal = self._goal.copy()

    @property
    def velocity(self) -> Array:
        """The velocity of the last step, rad/s."""
        return self._velocity

    def set_goal(self, goal: Array) -> None:
        """Set another goal; it is approached smoothly."""
        self._final_goal = np.array(goal, dtype=np.float64)

    def step(self, step_s: float, *, actual: Array | None = None) -> Array:
        """Advance by `step_s` and return the position; `actual` is the measured position, for phase stopping."""
        span = step_s / self.tau_s
        lag = np.zeros_like(self.position) if actual is None else actual - self.position
        self._goal = self._final_goal + np.exp(-self._a_g * span) * (self._goal - self._final_goal)
        push = self._a_z * (self._a_z / 4.0 * (self._goal - self.position) - self._rate) + self._forcing()
        self._rate = self._rate + span * push
        moved = span * (self._rate + self._stopping.a_py * lag)
        self.position = self.position + moved
        self._velocity = moved / step_s
        self._pass(span, float(np.linalg.norm(lag)))
        return self.position


class OnlineCartDmp(_OnlineDmp):
    """An active Cartesian DMP; `xyz` (m) and `xyzw` are its present pose in the primitive's frame.

    Set `tau_s` at any time to change the speed. `tasktrans` is not applied, see `poses_in_task_frame`.
    """

    def __init__(self, dmp: CartDmp, *, stopping: PhaseStopping = NEVER_STOPPING) -> None:
        super().__init__(dmp, np.array(dmp.weights), stopping)
        self.xyz = np.array(dmp.y0[:3])
        self.xyzw = np.array(dmp.y0[3:]) / np.linalg.norm(dmp.y0[3:])
        self._rate = dmp.tau * np.array(dmp.dy0)
        self._goal = np.array(dmp.goal[:3]), np.array(dmp.goal[3:]) / np.linalg.norm(dmp.goal[3:])
        self._final_goal = self._goal

    def set_goal(self, xyz: Array, xyzw: Array) -> None:
        """Set another goal; it is approached smoothly, and rotated along the shorter arc."""
        self._final_goal = np.array(xyz, dtype=np.float64), toward(xyzw / np.linalg.norm(xyzw), self._goal[1])

    def step(self, step_s: float, *, actual: tuple[Array, Array] | None = None) -> tuple[Array, Array]:
        """Advance by `step_s` and return position and orientation; `actual` is the measured tool pose."""
        span = step_s / self.tau_s
        lag, turn_lag = self._lag(actual)
        self._move_goal(span)
        force = self._forcing()
        pull = self._a_z / 4.0 * (self._goal[0] - self.xyz)
        rate = self._rate[:3] + span * (self._a_z * (pull - self._rate[:3]) + force[:3])
        x, y, z = self._rate[3:].tolist()
        a, b, c, d = self.xyzw.tolist()
        push = orientation_acceleration((a, b, c, d), (x, y, z), self._goal[1].tolist(), force[3:].tolist(), self._a_z)
        spin = self._rate[3:] + span * np.array(push)
        self._rate = np.concatenate((rate, spin))
        self.xyz = self.xyz + span * (rate + self._stopping.a_py * lag)
        x, y, z = (spin + self._stopping.a_py * turn_lag).tolist()
        self.xyzw = np.array(integrate_rotation((a, b, c, d), (x, y, z), span))
        angle_m = self._stopping.metres_per_rad * float(np.linalg.norm(turn_lag))
        self._pass(span, float(np.linalg.norm(lag)) + angle_m)
        return self.xyz, self.xyzw

    def _lag(self, actual: tuple[Array, Array] | None) -> tuple[Array, Array]:
        if actual is None:
            return np.zeros(3), np.zeros(3)
        return actual[0] - self.xyz, log(product(toward(actual[1], self.xyzw), conjugate(self.xyzw)))

    def _move_goal(self, span: float) -> None:
        left = np.exp(-self._a_g * span)
        (xyz, xyzw), (final, turn) = self._goal, self._final_goal
        ahead = product(exp(left * log(product(xyzw, conjugate(turn)))), turn)
        self._goal = final + left * (xyz - final), ahead
