"""Random smooth demonstrations: joints and tool poses led from rest to rest, sampled with noise."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from hypothesis import strategies as st

from engine.messages.demonstrations import Trajectory
from robots.motion.dmp.quaternions import exp, product
from robots.motion.min_jerk import min_jerk
from robots.port import Array

JOINTS = 7


@dataclass(frozen=True, kw_only=True)
class Demonstration:
    """A recording, and what was led without noise: joints (T, 7) or poses (T, 7)."""

    recorded: Trajectory
    truth: Array
    moving_s: float


def led_joints(
    seed: int, *, duration_s: float = 3.0, rest_s: float = 0.4, period_s: float = 0.01, noise_rad: float = 0.0
) -> Demonstration:
    """Joints that wave on their way between two configurations, resting before and after."""
    random = np.random.default_rng(seed)
    times, share = _times(duration_s, rest_s, period_s)
    start, end = random.uniform(-1.0, 1.0, (2, JOINTS))
    joints = start + (end - start) * share[:, None] + _waves(random, share, JOINTS, 0.3)
    noisy = joints + noise_rad * random.standard_normal((len(times), JOINTS))
    recorded = Trajectory(times_s=tuple(times.tolist()), joints=_rows(noisy))
    return Demonstration(recorded=recorded, truth=joints, moving_s=duration_s)


def led_tool(
    seed: int,
    *,
    duration_s: float = 3.0,
    rest_s: float = 0.4,
    period_s: float = 0.01,
    noise_m: float = 0.0,
    noise_rad: float = 0.0,
    turn_rad: float = 1.5,
) -> Demonstration:
    """A tool that waves on its way between two poses `turn_rad` apart, with a random sign for every quaternion."""
    random = np.random.default_rng(seed)
    times, share = _times(duration_s, rest_s, period_s)
    way = random.uniform(-0.4, 0.4, 3)
    xyz = way * share[:, None] + _waves(random, share, 3, 0.08)
    axis = random.normal(size=3)
    turn = axis / np.linalg.norm(axis) * turn_rad * share[:, None] + _waves(random, share, 3, 0.2)
    first = random.normal(size=4)
    xyzw = product(exp(turn), first / np.linalg.norm(first))
    truth = np.hstack((xyz, xyzw))
    noisy = np.hstack(
        (
            xyz + noise_m * random.normal(size=xyz.shape),
            product(exp(noise_rad * random.normal(size=turn.shape)), xyzw)
            * random.choice([-1.0, 1.0], (len(times), 1)),
        )
    )
    recorded = Trajectory(times_s=tuple(times.tolist()), poses=_rows(noisy))
    return Demonstration(recorded=recorded, truth=truth, moving_s=duration_s)


seeds = st.integers(0, 2**32 - 1)


def interpolated(at: Array, known: Array, values: Array) -> Array:
    """Values (T, n) known at the shares `known`, linearly in between, at the shares `at`."""
    rows = np.empty((len(at), values.shape[1]))
    for column in range(values.shape[1]):
        rows[:, column] = np.interp(at, known, values[:, column])
    return rows


def _times(duration_s: float, rest_s: float, period_s: float) -> tuple[Array, Array]:
    times = np.arange(0.0, duration_s + 2.0 * rest_s + period_s / 2.0, period_s)
    return times, min_jerk((times - rest_s) / duration_s)


def _waves(random: np.random.Generator, share: Array, width: int, size: float) -> Array:
    number = np.arange(1, 4)
    waves = np.sin(np.pi * share[:, None] * number) / number
    return np.asarray(waves @ (size * random.normal(size=(3, width))), dtype=np.float64)


def _rows(values: Array) -> tuple[tuple[float, ...], ...]:
    return tuple(tuple(row) for row in values.tolist())
