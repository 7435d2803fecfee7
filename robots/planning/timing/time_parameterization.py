"""Time parameterization of a path: time-optimal by reachability analysis, then averaged to respect the jerk limits.

A moving average keeps the path, since only the time law is averaged; it turns each step of the
acceleration into a ramp as long as the window (like the finite impulse response filters of Biagiotti and Melchiorri,
"FIR filters for online trajectory planning with time- and frequency-domain specifications", 2012).
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np

from engine.errors import RobotError
from robots.planning.timing.blending import BlendedPath
from robots.planning.timing.time_parameterization_kernels import limit_ratios, path_rates, samples
from robots.planning.timing.topp_ra_kernels import passing_rates, passing_times
from robots.port import Array

_LOOK_S, _SHORTEST_S = 0.001, 0.002
_WINDOW_ROUNDS = 8
# Excess over the limits is reduced locally while it is above this ratio, the rest by a longer duration.
_ROUNDS, _LITTLE = 3, 1.01
_ANY_SQUARE = 1e12


@dataclass(frozen=True, kw_only=True)
class JointRateLimits:
    """Limits of each joint: rad/s, rad/s², rad/s³, each (n,)."""

    velocity: Array
    acceleration: Array
    jerk: Array


@dataclass(frozen=True, kw_only=True)
class TimeParameterization:
    """The time law of a path from rest to rest; times are seconds from its start.

    Before the average over `window_s`, the squared rate, `squares` (points of the path,), is linear
    between the points; after the average the duration is scaled by `stretch`.
    """

    along: Array
    pieces: Array
    squares: Array
    passed_s: Array
    window_s: float = _SHORTEST_S
    stretch: float = 1.0

    @property
    def duration_s(self) -> float:
        """The duration."""
        return (float(self.passed_s[-1]) + self.window_s) * self.stretch

    def sampled(self, times_s: Array) -> tuple[Array, Array]:
        """Return the joints' positions and velocities at times (k,) in order, (k, n) each."""
        position, velocity = samples(self.along, self.pieces, self._path_rates(times_s))
        return position, velocity / self.stretch

    def uses(self, times_s: Array, limits: JointRateLimits) -> Array:
        """Return the limit ratios at times (k,) in order, as `limit_ratios` defines, without the stretch."""
        rates = self._path_rates(times_s)
        return limit_ratios(self.along, self.pieces, rates, limits.velocity, limits.acceleration, limits.jerk)

    def times_at(self, lengths: Array) -> Array:
        """Return the times at which the arc lengths (k,) in order are reached, within a millisecond."""
        times_s = self.looks()
        return np.interp(lengths, self._path_rates(times_s)[0], times_s)

    def looks(self) -> Array:
        """Return times so close that no limit is exceeded unnoticed between them."""
        return np.linspace(0.0, self.duration_s, max(3, math.ceil(self.duration_s / _LOOK_S) + 1))

    def _path_rates(self, times_s: Array) -> Array:
        return path_rates(self.along, self.squares, self.passed_s, self.window_s, times_s / self.stretch)


def time_optimal(
    path: BlendedPath, limits: JointRateLimits, *, most_squares: Array | None = None
) -> TimeParameterization:
    """Return the nearly time-optimal time law of a path within the joints' limits, at rest at both ends.

    `most_squares` (points of the path,) bounds the squared rate at each point further.

    Raises:
        RobotError: no time law respects the acceleration limits.
    """
    first, second, pieces = np.ascontiguousarray(path.first), np.ascontiguousarray(path.second), path.pieces()
    ceiling = np.full(len(path.along), _ANY_SQUARE) if most_squares is None else most_squares
    best: TimeParameterization | None = None
    for _ in range(_ROUNDS):
        squares = passing_rates(first, second, path.along, limits.velocity, limits.acceleration, ceiling.copy())
        passed_s = passing_times(path.along, squares)
        if not math.isfinite(passed_s[-1]):
            break
        law = TimeParameterization(along=path.along, pieces=pieces, squares=squares, passed_s=passed_s)
        law, used = _averaged(law, limits)
        # Scaling the duration divides speeds by the factor, accelerations by its square, jerks by its cube.
        stretched = replace(law, stretch=max(1.0, float(used.max())))
        if best is None or stretched.duration_s < best.duration_s:
            best = stretched
        if stretched.stretch <= _LITTLE:
            break
        ceiling = np.minimum(ceiling, _reduced_ceiling(law, used))
    if best is None:
        raise RobotError(
            "the path cannot be followed within the joints' accelerations", hint="check the model's limits"
        )
    return best


def _averaged(law: TimeParameterization, limits: JointRateLimits) -> tuple[TimeParameterization, Array]:
    """Return the law with a window long enough for the jerk limit of its acceleration changes, and its limit ratios."""
    for _ in range(_WINDOW_ROUNDS):
        hardest = float(law.uses(law.looks(), limits)[1].max())
        if hardest <= 1.0:
            break
        # The acceleration changes by at most its whole range, so this terminates.
        law = replace(law, window_s=law.window_s * hardest)
    return law, law.uses(law.looks(), limits)[0]


def _reduced_ceiling(law: TimeParameterization, used: Array) -> Array:
    """Return the upper bound of the squared rate at each point that removes the excess over the limits."""
    over = used > 1.0
    # A point passed at some time before averaging affects the window that starts then.
    wait = law.looks()[over][None] - law.passed_s[:, None]
    counts = (wait >= -_LOOK_S) & (wait <= law.window_s + _LOOK_S)
    worst = np.where(counts, used[over][None], 1.0).max(axis=1, initial=1.0)
    return np.where(worst > 1.0, law.squares / worst**2, _ANY_SQUARE)
