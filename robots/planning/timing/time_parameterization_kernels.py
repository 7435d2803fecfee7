"""The compiled core of time laws: the motion along a path over time, its limit ratios, and the joints' samples.

Of a path, `along` (k,) are the arc lengths at its points and `pieces` (k - 1, 6, n) the coefficients of each joint's
polynomial between two of them, by the share u in [0, 1] of the length between.
"""

from __future__ import annotations

import math

import numpy as np

from robots.compiled import compiled
from robots.port import Array

_ROW, _MATRIX, _PIECES = "f8[::1]", "f8[:,::1]", "f8[:,:,::1]"


@compiled(f"{_MATRIX}({_ROW}, {_ROW}, {_ROW}, f8, {_ROW})")
def path_rates(along: Array, squares: Array, passed: Array, window: float, at: Array) -> Array:
    """Return the arc length and its time derivatives rate, push and rise, averaged over a window, (4, m).

    The points of the path are passed at times `passed` (k,), with the squared rates `squares` (k,),
    linear between. `at` (m,) are times in order; each average is over the window that ends there.
    """
    last = len(along) - 1
    out = np.zeros((4, len(at)))
    sums = np.zeros(last + 1)
    for i in range(last):
        t, rate = passed[i + 1] - passed[i], math.sqrt(squares[i])
        push = 0.5 * (squares[i + 1] - squares[i]) / (along[i + 1] - along[i])
        sums[i + 1] = sums[i] + t * (along[i] + t * (rate / 2.0 + t * push / 6.0))
    for end in range(2):
        sign = (1.0 - 2.0 * end) / window
        i = 0
        for m in range(len(at)):
            time = at[m] - window * end
            if time <= 0.0:
                continue
            if time >= passed[last]:
                out[0, m] += sign * (sums[last] + along[last] * (time - passed[last]))
                out[1, m] += sign * along[last]
                continue
            while passed[i + 1] <= time:
                i += 1
            t, rate = time - passed[i], math.sqrt(squares[i])
            push = 0.5 * (squares[i + 1] - squares[i]) / (along[i + 1] - along[i])
            out[0, m] += sign * (sums[i] + t * (along[i] + t * (rate / 2.0 + t * push / 6.0)))
            out[1, m] += sign * (along[i] + t * (rate + t * push / 2.0))
            out[2, m] += sign * (rate + t * push)
            out[3, m] += sign * push
    for m in range(len(at)):
        out[0, m] = min(max(out[0, m], 0.0), along[last])
        out[1, m] = max(out[1, m], 0.0)
    return out


@compiled(f"{_MATRIX}({_ROW}, {_PIECES}, {_MATRIX}, {_ROW}, {_ROW}, {_ROW})")
def limit_ratios(along: Array, pieces: Array, pace: Array, fastest: Array, most: Array, hardest: Array) -> Array:
    """Return the time scaling with which the joints would respect their limits, at each time, (2, m).

    The second row is the share of the jerk limit that the rise alone takes. `pace` (4, m) is the result of
    `path_rates`; `fastest`, `most` and `hardest` (n,) are the limits of speed, acceleration and jerk.
    """
    out = np.zeros((2, pace.shape[1]))
    i = 0
    for m in range(pace.shape[1]):
        while i < len(along) - 2 and along[i + 1] <= pace[0, m]:
            i += 1
        h = along[i + 1] - along[i]
        u = (pace[0, m] - along[i]) / h
        rate, push, rise = pace[1, m] / h, pace[2, m] / h, pace[3, m] / h
        for j in range(len(fastest)):
            c1, c2, c3 = pieces[i, 1, j], 2.0 * pieces[i, 2, j], 3.0 * pieces[i, 3, j]
            c4, c5 = 4.0 * pieces[i, 4, j], 5.0 * pieces[i, 5, j]
            first = c1 + u * (c2 + u * (c3 + u * (c4 + u * c5)))
            second = c2 + u * (2.0 * c3 + u * (3.0 * c4 + u * 4.0 * c5))
            third = 2.0 * c3 + u * (6.0 * c4 + u * 12.0 * c5)
            speed = abs(first * rate) / fastest[j]
            change = abs(second * rate * rate + first * push) / most[j]
            jerk = abs(third * rate**3 + 3.0 * second * rate * push + first * rise) / hardest[j]
            out[0, m] = max(out[0, m], speed, math.sqrt(change), jerk ** (1.0 / 3.0))
            out[1, m] = max(out[1, m], abs(first * rise) / hardest[j])
    return out


@compiled(f"{_PIECES}({_ROW}, {_PIECES}, {_MATRIX})")
def samples(along: Array, pieces: Array, pace: Array) -> Array:
    """Return positions and velocities (2, m, n) of the joints."""
    out = np.empty((2, pace.shape[1], pieces.shape[2]))
    i = 0
    for m in range(pace.shape[1]):
        while i < len(along) - 2 and along[i + 1] <= pace[0, m]:
            i += 1
        h = along[i + 1] - along[i]
        u = (pace[0, m] - along[i]) / h
        for j in range(pieces.shape[2]):
            c1, c2, c3 = pieces[i, 1, j], pieces[i, 2, j], pieces[i, 3, j]
            c4, c5 = pieces[i, 4, j], pieces[i, 5, j]
            out[0, m, j] = pieces[i, 0, j] + u * (c1 + u * (c2 + u * (c3 + u * (c4 + u * c5))))
            slope = c1 + u * (2.0 * c2 + u * (3.0 * c3 + u * (4.0 * c4 + u * 5.0 * c5)))
            out[1, m, j] = slope * pace[1, m] / h
    return out
