"""How far along a way at each time: as reachability allows, averaged over a moment so that no jerk is too hard.

An average over a moving window keeps to the way, since only the time law is averaged; it turns each step of the
acceleration into a ramp as long as the window (as the finite impulse response filters of Biagiotti and Melchiorri,
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
# What is used beyond the limits is mended where it happens while it is more than a little, the rest by taking longer.
_ROUNDS, _LITTLE = 3, 1.01
_ANY_SQUARE = 1e12


@dataclass(frozen=True, kw_only=True)
class JointRateLimits:
    """What each joint may do: rad/s, rad/s², rad/s³, each (n,)."""

    velocity: Array
    acceleration: Array
    jerk: Array


@dataclass(frozen=True, kw_only=True)
class TimeParameterization:
    """Passes a way from rest to rest; times are seconds from its start.

    Before the average over `window_s` is taken, the square of the rate, `squares` (points of the way,), is linear
    between the points; after it everything takes `stretch` times as long.
    """

    along: Array
    pieces: Array
    squares: Array
    passed_s: Array
    window_s: float = _SHORTEST_S
    stretch: float = 1.0

    @property
    def duration_s(self) -> float:
        """How long it takes."""
        return (float(self.passed_s[-1]) + self.window_s) * self.stretch

    def sampled(self, times_s: Array) -> tuple[Array, Array]:
        """Return the joints' positions and velocities at times (k,) in order, (k, n) each."""
        position, velocity = samples(self.along, self.pieces, self._paces(times_s))
        return position, velocity / self.stretch

    def uses(self, times_s: Array, limits: JointRateLimits) -> Array:
        """Return what is used of the limits at times (k,) in order, as the kernel of this name does, unstretched."""
        pace = self._paces(times_s)
        return limit_ratios(self.along, self.pieces, pace, limits.velocity, limits.acceleration, limits.jerk)

    def looks(self) -> Array:
        """Return times so close that nothing happens between them."""
        return np.linspace(0.0, self.duration_s, max(3, math.ceil(self.duration_s / _LOOK_S) + 1))

    def _paces(self, times_s: Array) -> Array:
        return path_rates(self.along, self.squares, self.passed_s, self.window_s, times_s / self.stretch)


def time_optimal(way: BlendedPath, limits: JointRateLimits) -> TimeParameterization:
    """Return how a way is passed, at rest at both ends, as fast as the joints' limits allow, or nearly so.

    Raises:
        RobotError: it cannot be passed at all.
    """
    first, second, pieces = np.ascontiguousarray(way.first), np.ascontiguousarray(way.second), way.pieces()
    ceiling = np.full(len(way.along), _ANY_SQUARE)
    best: TimeParameterization | None = None
    for _ in range(_ROUNDS):
        squares = passing_rates(first, second, way.along, limits.velocity, limits.acceleration, ceiling.copy())
        passed_s = passing_times(way.along, squares)
        if not math.isfinite(passed_s[-1]):
            break
        law = TimeParameterization(along=way.along, pieces=pieces, squares=squares, passed_s=passed_s)
        law, used = _averaged(law, limits)
        # Taking longer by a factor divides speeds by it, accelerations by its square, jerks by its cube.
        longer = replace(law, stretch=max(1.0, float(used.max())))
        if best is None or longer.duration_s < best.duration_s:
            best = longer
        if longer.stretch <= _LITTLE:
            break
        ceiling = np.minimum(ceiling, _mended(law, used))
    if best is None:
        raise RobotError(
            "the path cannot be followed within the joints' accelerations", hint="check the model's limits"
        )
    return best


def _averaged(law: TimeParameterization, limits: JointRateLimits) -> tuple[TimeParameterization, Array]:
    """Return the law with a window so long that no change of the push within it is too hard, and what it uses then."""
    for _ in range(_WINDOW_ROUNDS):
        hardest = float(law.uses(law.looks(), limits)[1].max())
        if hardest <= 1.0:
            break
        # The push changes by its whole range at most, so this comes to an end.
        law = replace(law, window_s=law.window_s * hardest)
    return law, law.uses(law.looks(), limits)[0]


def _mended(law: TimeParameterization, used: Array) -> Array:
    """Return how large the squares of the rates may be where more than the limits is used, at each point."""
    over = used > 1.0
    # What is passed at a moment before averaging counts for a window from then on.
    wait = law.looks()[over][None] - law.passed_s[:, None]
    counts = (wait >= -_LOOK_S) & (wait <= law.window_s + _LOOK_S)
    worst = np.where(counts, used[over][None], 1.0).max(axis=1, initial=1.0)
    return np.where(worst > 1.0, law.squares / worst**2, _ANY_SQUARE)
