"""Learns movement primitives from recorded motions, and measures their fit."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import TypeVar

import msgspec
import numpy as np

from engine.errors import RobotError
from engine.messages.demonstrations import Trajectory
from engine.messages.primitives import CartDmp, JointDmp
from engine.skills.dmp import CartFit, JointFit, LearnedCartDmp, LearnedJointDmp, TrimInterval
from robots.motion.dmp.integration import integrate_joints, integrate_pose
from robots.motion.dmp.kernels import GaussianKernels, phase_at
from robots.motion.dmp.quaternions import conjugate, continuous, log, product, toward
from robots.motion.dmp.smoothing import RestEnds, smooth
from robots.motion.dmp.trimming import MotionChannel, find_motion_window
from robots.port import Array

L = TypeVar("L")

CANDIDATES = (10, 15, 25, 40, 60, 90, 130, 184)
"""Kernel numbers tried by default; RCL allows 184."""

GOOD_RAD, GOOD_M, GOOD_TURN_RAD = 1e-3, 5e-4, 2e-3
"""Errors below which no more kernels are tried."""

# Speeds below which a recorded arm is at rest.
_REST_RAD_S, _REST_M_S, _REST_TURN_RAD_S = 2e-3, 5e-4, 2e-3
# Fewer kernels are preferred unless more kernels reduce the error by more than this factor.
_WORTHWHILE = 1.15
_SAMPLES_PER_KERNEL = 10
_FEWEST_POINTS = 400
# Share of the duration until which an arm that rests at the end is constrained to rest.
_REST_AFTER = 1.4
_MOST_TURN_RAD = 6.0
_TOOL_SAMPLES = 1000
# Regularises the regression where kernels overlap almost entirely; too small to affect the motion.
_RIDGE = 1e-9


@dataclass(frozen=True, kw_only=True)
class _LearnedSection:
    """The learned part of a recording: shares of its duration (T,), its rest ends, and the trimmed times."""

    shares: Array
    duration_s: float
    taken: slice
    rest_ends: RestEnds
    cut: TrimInterval


def learn_joint_dmp(
    recorded: Trajectory,
    *,
    kernels: int = 0,
    a_z: float = 48.0,
    a_x: float = 2.0,
    trim: bool = True,
    tool_at: Callable[[Array], Array] | None = None,
) -> LearnedJointDmp:
    """Return the joint DMP of a recording and its fit; `kernels` 0 selects the number automatically.

    With `tool_at`, which returns the tool position (m) for joints, the fit includes the tool error.

    Raises:
        RobotError: the recording has no joints, too few samples, or no motion.
    """
    if not recorded.joints:
        raise RobotError("the recording has no joints", hint="record `joints`, or learn a Cartesian primitive")
    joints = np.array(recorded.joints)
    part = _part(recorded, [MotionChannel(values=joints, rest=_REST_RAD_S)], trim=trim)
    demonstrated = joints[part.taken]

    def learned(number: int) -> LearnedJointDmp:
        dmp = _joint_dmp(part, demonstrated, number, a_z=a_z, a_x=a_x)
        return LearnedJointDmp(dmp=dmp, fit=_joint_fit(dmp, part, demonstrated))

    def error(one: LearnedJointDmp) -> tuple[float, bool]:
        return one.fit.rms_rad, one.fit.max_rad <= GOOD_RAD

    best = _best(learned, error, _numbers(kernels, part))
    return best if tool_at is None else _with_tool(best, part, demonstrated, tool_at)


def learn_cart_dmp(
    recorded: Trajectory, *, kernels: int = 0, a_z: float = 48.0, a_x: float = 2.0, trim: bool = True
) -> LearnedCartDmp:
    """Return the Cartesian DMP of a recording's tool poses and its fit; `kernels` 0 selects the number automatically.

    Raises:
        RobotError: the recording has no tool poses, too few samples, no motion, or a rotation near a full turn.
    """
    if not recorded.poses:
        raise RobotError("the recording has no tool poses", hint="record `poses`")
    poses = np.array(recorded.poses)
    turns = continuous(poses[:, 3:])
    moving = [
        MotionChannel(values=poses[:, :3], rest=_REST_M_S),
        # The quaternion's components change at half the angular speed.
        MotionChannel(values=turns, rest=_REST_TURN_RAD_S / 2.0),
    ]
    part = _part(recorded, moving, trim=trim)
    xyz, xyzw = poses[part.taken, :3], _positive_goal(turns[part.taken])
    _check_turn(xyzw)

    def learned(number: int) -> LearnedCartDmp:
        dmp = _cart_dmp(part, xyz, xyzw, number, a_z=a_z, a_x=a_x)
        dmp = msgspec.structs.replace(dmp, frame=recorded.frame)
        return LearnedCartDmp(dmp=dmp, fit=_cart_fit(dmp, part, xyz, xyzw))

    def error(one: LearnedCartDmp) -> tuple[float, bool]:
        fit = one.fit
        return fit.rms_m / GOOD_M + fit.rms_rad / GOOD_TURN_RAD, fit.max_m <= GOOD_M and fit.max_rad <= GOOD_TURN_RAD

    return _best(learned, error, _numbers(kernels, part))


def _positive_goal(xyzw: Array) -> Array:
    """Return a continuous sequence of quaternions with the sign that makes the last w positive."""
    return -xyzw if xyzw[-1, 3] < 0.0 else xyzw


def _check_turn(xyzw: Array) -> None:
    """Reject a motion that comes near a full turn from its end, where the direction to the goal is undefined."""
    farthest = float(np.linalg.norm(log(product(xyzw[-1], conjugate(xyzw))), axis=1).max())
    if farthest > _MOST_TURN_RAD:
        raise RobotError(
            f"the tool turns by {np.degrees(farthest):.0f}° in the recording, which one primitive cannot represent",
            hint="learn it in two parts, each less than a whole turn",
        )


def _part(recorded: Trajectory, channels: Sequence[MotionChannel], *, trim: bool) -> _LearnedSection:
    times = np.array(recorded.times_s)
    moving = find_motion_window(times, channels)
    taken = moving.taken if trim else slice(0, len(times))
    used = times[taken]
    duration_s = float(used[-1] - used[0])
    cut = TrimInterval(start_s=float(used[0] - times[0]), end_s=float(used[-1] - times[0]))
    return _LearnedSection(
        shares=(used - used[0]) / duration_s, duration_s=duration_s, taken=taken, rest_ends=moving.rest_ends, cut=cut
    )


def _numbers(kernels: int, part: _LearnedSection) -> tuple[int, ...]:
    if kernels:
        return (kernels,)
    most = max(CANDIDATES[0], len(part.shares) // 3)
    return tuple(number for number in CANDIDATES if number <= most)


def _best(learn: Callable[[int], L], error: Callable[[L], tuple[float, bool]], numbers: tuple[int, ...]) -> L:
    """Return the first sufficient fit, else the one with fewest kernels among those about as good as the best."""
    tried: list[tuple[float, L]] = []
    for number in numbers:
        learned = learn(number)
        size, good = error(learned)
        if good:
            return learned
        if math.isfinite(size):
            tried.append((size, learned))
    if not tried:
        raise RobotError("learning the movement primitive overflows", hint="choose smaller gains a_z and a_x")
    least = min(size for size, _ in tried)
    return next(learned for size, learned in tried if size <= _WORTHWHILE * least)


def _fit_shares(number: int) -> Array:
    """Return the shares at which `number` kernels are fitted."""
    return np.linspace(0.0, 1.0, max(_FEWEST_POINTS, _SAMPLES_PER_KERNEL * number) + 1)


def _weights(
    kernels: GaussianKernels, shares: Array, force: Array, *, a_x: float, rest_ends: RestEnds
) -> tuple[tuple[float, ...], ...]:
    """Return the weights, one row for each column of the forcing term (T, n), by least squares.

    An arm at rest at the end needs zero force afterwards too: otherwise the last kernel, active
    while the phase decays, would hold the arm away from its goal.
    """
    if rest_ends.end:
        after = np.linspace(1.0, _REST_AFTER, max(2, len(shares) // 5))[1:]
        shares, force = np.append(shares, after), np.vstack((force, np.zeros((len(after), force.shape[1]))))
    phase = phase_at(shares, a_x)
    basis = phase[:, None] * kernels.at(phase)
    normal = basis.T @ basis
    normal[np.diag_indices_from(normal)] += _RIDGE * float(normal.max())
    return tuple(tuple(row) for row in np.linalg.solve(normal, basis.T @ force).T.tolist())


def _joint_dmp(part: _LearnedSection, joints: Array, number: int, *, a_z: float, a_x: float) -> JointDmp:
    kernels, shares = GaussianKernels.evenly(number, a_x=a_x), _fit_shares(number)
    value, rate, push = smooth(part.shares, joints, intervals=2 * number, rest_ends=part.rest_ends).at(shares)
    force = push + a_z * rate - a_z * a_z / 4.0 * (value[-1] - value)
    return JointDmp(
        N=number,
        a_z=a_z,
        a_x=a_x,
        tau=part.duration_s,
        goal=_row(value[-1]),
        y0=_row(value[0]),
        dy0=_row(rate[0] / part.duration_s),
        c=_row(kernels.c),
        sigma=_row(kernels.sigma),
        w=_weights(kernels, shares, force, a_x=a_x, rest_ends=part.rest_ends),
    )


def _cart_dmp(part: _LearnedSection, xyz: Array, xyzw: Array, number: int, *, a_z: float, a_x: float) -> CartDmp:
    kernels, shares = GaussianKernels.evenly(number, a_x=a_x), _fit_shares(number)
    motion = smooth(part.shares, np.hstack((xyz, xyzw)), intervals=2 * number, rest_ends=part.rest_ends)
    value, rate, push = motion.at(shares)
    turn, spin, spin_push = _spin(value[:, 3:], rate[:, 3:], push[:, 3:])
    missing = np.hstack((value[-1, :3] - value[:, :3], log(product(turn[-1], conjugate(turn)))))
    speed = np.hstack((rate[:, :3], spin))
    force = np.hstack((push[:, :3], spin_push)) + a_z * speed - a_z * a_z / 4.0 * missing
    w1, w2, w3, w4, w5, w6 = _weights(kernels, shares, force, a_x=a_x, rest_ends=part.rest_ends)
    return CartDmp(
        N=number,
        a_z=a_z,
        a_x=a_x,
        tau=part.duration_s,
        goal=_row(np.concatenate((value[-1, :3], turn[-1]))),
        y0=_row(np.concatenate((value[0, :3], turn[0]))),
        dy0=_row(speed[0] / part.duration_s),
        c=_row(kernels.c),
        sigma=_row(kernels.sigma),
        w1=w1, w2=w2, w3=w3, w4=w4, w5=w5, w6=w6,
    )  # fmt: skip


def _spin(raw: Array, rate: Array, push: Array) -> tuple[Array, Array, Array]:
    """Return orientations (T, 4), angular velocity and acceleration (T, 3) of quaternions of any length.

    A component along the quaternion changes only its length, which cancels in ω = 2 vec(q̇ conj(q)) / |q|².
    """
    square = (raw * raw).sum(axis=1, keepdims=True)
    spin = 2.0 * product(rate, conjugate(raw))[:, :3] / square
    relative_rate = 2.0 * (raw * rate).sum(axis=1, keepdims=True) / square
    return raw / np.sqrt(square), spin, 2.0 * product(push, conjugate(raw))[:, :3] / square - spin * relative_rate


def _joint_fit(dmp: JointDmp, part: _LearnedSection, demonstrated: Array) -> JointFit:
    path = integrate_joints(dmp)
    error = _at(part.shares, path.shares, path.position) - demonstrated
    return JointFit(
        kernels=dmp.N,
        rms_rad=float(np.sqrt((error**2).mean())),
        max_rad=float(np.abs(error).max()),
        end_rad=float(np.abs(path.position[-1] - np.array(dmp.goal)).max()),
        joint=int(np.argmax(np.abs(error).max(axis=0))),
        cut=part.cut,
    )


def _with_tool(
    learned: LearnedJointDmp, part: _LearnedSection, demonstrated: Array, tool_at: Callable[[Array], Array]
) -> LearnedJointDmp:
    """Add the tool error, at a limited number of samples."""
    path = integrate_joints(learned.dmp)
    rows = np.unique(np.linspace(0, len(demonstrated) - 1, min(len(demonstrated), _TOOL_SAMPLES)).astype(int))
    made = _at(part.shares[rows], path.shares, path.position)
    pairs = zip(made, demonstrated[rows], strict=True)
    away = np.array([np.linalg.norm(tool_at(one) - tool_at(other)) for one, other in pairs])
    fit = msgspec.structs.replace(learned.fit, rms_m=float(np.sqrt((away**2).mean())), max_m=float(away.max()))
    return msgspec.structs.replace(learned, fit=fit)


def _cart_fit(dmp: CartDmp, part: _LearnedSection, xyz: Array, xyzw: Array) -> CartFit:
    path = integrate_pose(dmp)
    turn = _at(part.shares, path.shares, path.xyzw)
    away = np.linalg.norm(_at(part.shares, path.shares, path.xyz) - xyz, axis=1)
    angle = np.linalg.norm(log(product(turn / np.linalg.norm(turn, axis=1, keepdims=True), conjugate(xyzw))), axis=1)
    goal = toward(np.array(dmp.goal[3:]), path.xyzw[-1])
    return CartFit(
        kernels=dmp.N,
        rms_m=float(np.sqrt((away**2).mean())),
        max_m=float(away.max()),
        end_m=float(np.linalg.norm(path.xyz[-1] - np.array(dmp.goal[:3]))),
        rms_rad=float(np.sqrt((angle**2).mean())),
        max_rad=float(angle.max()),
        end_rad=float(np.linalg.norm(log(product(goal, conjugate(path.xyzw[-1]))))),
        cut=part.cut,
    )


def _at(shares: Array, known: Array, values: Array) -> Array:
    columns: list[Array] = [np.interp(shares, known, column) for column in values.T]
    return np.column_stack(columns)


def _row(values: Array) -> tuple[float, ...]:
    return tuple(values.tolist())
