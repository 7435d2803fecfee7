"""Integrates movement primitives: joints or tool poses over time, with optional goal changes.

Time is normalised to the duration tau, so a path does not depend on its duration.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from engine.messages.primitives import CartDmp, JointDmp
from robots.motion.dmp.attractor import AttractorResponse, attract, attract_orientation
from robots.motion.dmp.kernels import GaussianKernels, phase_at
from robots.motion.dmp.quaternions import conjugate, exp, log, product, toward
from robots.port import Array

_STEPS = 500
# Minimum number of samples between the centres of two kernels.
_STEPS_PER_KERNEL = 6


@dataclass(frozen=True, kw_only=True)
class GoalChange:
    """At `share` of tau the goal becomes `goal`, (n,) or x y z and quaternion (7,).

    The attractor's goal moves there as tau ġ = a_g (goal - g), so that the acceleration
    does not jump (Ijspeert et al. 2013, section 2.1.6); `a_g` is a_z / 4 by default.
    """

    share: float
    goal: Array
    a_g: float | None = None


@dataclass(frozen=True, kw_only=True)
class JointPath:
    """Joints at even shares of tau: radians, per tau and per tau², (T, n)."""

    shares: Array
    position: Array
    rate: Array
    push: Array


@dataclass(frozen=True, kw_only=True)
class PosePath:
    """Poses at even shares of tau: metres (T, 3), unit quaternions (T, 4), their rates (T, 6) and pushes (T, 6)."""

    shares: Array
    xyz: Array
    xyzw: Array
    rate: Array
    push: Array


def integrate_joints(
    dmp: JointDmp, *, end: float = 1.0, changes: Sequence[GoalChange] = (), steps: int | None = None
) -> JointPath:
    """Return the joints from 0 to `end` shares of tau; `tasktrans` is not applied, see `in_task_frame`.

    `steps` is the number of samples per tau, automatic when None.
    """
    shares = _shares(end, dmp.N, steps)
    response = attract(
        force=_forcing(dmp, dmp.w, shares),
        goal=_joint_goals(dmp, shares, changes),
        value=np.array(dmp.y0),
        rate=dmp.tau * np.array(dmp.dy0),
        a_z=dmp.a_z,
        step=float(shares[1]),
    )
    return JointPath(shares=shares, position=response.value, rate=response.rate, push=response.push)


def integrate_pose(
    dmp: CartDmp, *, end: float = 1.0, changes: Sequence[GoalChange] = (), steps: int | None = None
) -> PosePath:
    """Return the tool's poses from 0 to `end` shares of tau, in the primitive's frame; `tasktrans` is not applied."""
    shares = _shares(end, dmp.N, steps)
    between = np.linspace(0.0, float(shares[-1]), 2 * len(shares) - 1)
    goal = _pose_goals(dmp, between, changes)
    rate = dmp.tau * np.array(dmp.dy0)
    place = attract(
        force=_forcing(dmp, dmp.weights[:3], shares),
        goal=goal[::2, :3],
        value=np.array(dmp.y0[:3]),
        rate=rate[:3],
        a_z=dmp.a_z,
        step=float(shares[1]),
    )
    turn = attract_orientation(
        force=_forcing(dmp, dmp.weights[3:], between),
        goal=goal[:, 3:],
        value=_unit(dmp.y0[3:]),
        rate=rate[3:],
        a_z=dmp.a_z,
        step=float(shares[1]),
    )
    return _pose_path(shares, place, turn)


def _pose_path(shares: Array, place: AttractorResponse, turn: AttractorResponse) -> PosePath:
    return PosePath(
        shares=shares,
        xyz=place.value,
        xyzw=turn.value,
        rate=np.hstack((place.rate, turn.rate)),
        push=np.hstack((place.push, turn.push)),
    )


def _joint_goals(dmp: JointDmp, shares: Array, changes: Sequence[GoalChange]) -> Array:
    goal = np.tile(np.array(dmp.goal), (len(shares), 1))
    for change in changes:
        late = shares >= change.share
        goal[late] = change.goal + _left(dmp, change, shares[late]) * (goal[late] - change.goal)[:1]
    return goal


def _left(dmp: JointDmp | CartDmp, change: GoalChange, shares: Array) -> Array:
    """Return the remaining share of the path to the new goal at `shares` after the change, (T, 1)."""
    return np.exp(-(change.a_g or dmp.a_z / 4.0) * (shares - change.share))[:, None]


def _pose_goals(dmp: CartDmp, shares: Array, changes: Sequence[GoalChange]) -> Array:
    goal = np.tile(np.concatenate((dmp.goal[:3], _unit(dmp.goal[3:]))), (len(shares), 1))
    for change in changes:
        late = shares >= change.share
        if not late.any():
            continue
        left, old = _left(dmp, change, shares[late]), goal[late][0]
        new = toward(_unit(change.goal[3:]), old[3:])
        goal[late, :3] = change.goal[:3] + left * (old[:3] - change.goal[:3])
        goal[late, 3:] = product(exp(left * log(product(old[3:], conjugate(new)))), new)
    return goal


def _shares(end: float, kernels: int, steps: int | None) -> Array:
    per_tau = steps or max(_STEPS, _STEPS_PER_KERNEL * kernels)
    count = max(2, math.ceil(end * per_tau - 1e-9))
    return np.linspace(0.0, end, count + 1)


def _forcing(dmp: JointDmp | CartDmp, weights: Sequence[Sequence[float]], shares: Array) -> Array:
    """Return the forcing term f(x) = x Σ w psi / Σ psi, (T, n)."""
    phase = phase_at(shares, dmp.a_x)
    return phase[:, None] * (GaussianKernels.of(dmp.c, dmp.sigma).at(phase) @ np.array(weights, dtype=np.float64).T)


def _unit(xyzw: Sequence[float] | Array) -> Array:
    quaternion = np.array(xyzw, dtype=np.float64)
    return quaternion / np.linalg.norm(quaternion)
