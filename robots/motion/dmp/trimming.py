"""Finds where a recorded motion begins and ends, between the rest before and after it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from engine.errors import RobotError
from robots.motion.dmp.smoothing import FEWEST_SAMPLES, RestEnds, smooth
from robots.port import Array

# Speeds are evaluated after smoothing over about this time; this much rest is kept at either end.
_SMOOTHING_S, _KEPT_REST_S = 0.1, 0.1
_SHARE_OF_PEAK = 0.01
# Apparent speed of noise after smoothing, in multiples of its size over time and root of samples.
_NOISE_GAIN = 8.0


@dataclass(frozen=True, kw_only=True)
class MotionChannel:
    """Values that move together, (T, n), and the speed below which they are at rest regardless of their peak."""

    values: Array
    rest: float


@dataclass(frozen=True, kw_only=True)
class MotionWindow:
    """The samples from the start to the end of a motion with a little rest, and whether it was at rest there."""

    taken: slice
    rest_ends: RestEnds


def find_motion_window(times_s: Array, channels: Sequence[MotionChannel]) -> MotionWindow:
    """Return the window of the motion in a recording.

    Raises:
        RobotError: there are too few samples, or nothing moves.
    """
    if len(times_s) < FEWEST_SAMPLES:
        raise RobotError(
            f"the recording has {len(times_s)} samples", hint=f"record at least {FEWEST_SAMPLES} of the motion"
        )
    moves = np.zeros(len(times_s), dtype=bool)
    for channel in channels:
        moves |= _moves(times_s, channel)
    if not moves.any():
        raise RobotError("nothing moves in the recording", hint="record while the arm is guided")
    first, last = (float(times_s[at]) for at in np.flatnonzero(moves)[[0, -1]])
    begin = int(np.searchsorted(times_s, first - _KEPT_REST_S))
    end = int(np.searchsorted(times_s, last + _KEPT_REST_S, side="right"))
    return MotionWindow(
        taken=slice(begin, end),
        rest_ends=RestEnds(
            start=first - float(times_s[0]) >= _KEPT_REST_S / 2.0, end=float(times_s[-1]) - last >= _KEPT_REST_S / 2.0
        ),
    )


def _moves(times_s: Array, channel: MotionChannel) -> Array:
    """Return at which samples a channel moves faster than its rest speed, its noise and a small share of its peak."""
    duration_s = float(times_s[-1] - times_s[0])
    shares = (times_s - times_s[0]) / duration_s
    intervals = max(8, round(duration_s / _SMOOTHING_S))
    smoothed = smooth(shares, channel.values, intervals=intervals, rest_ends=RestEnds(start=True, end=True))
    values, rates, _ = smoothed.at(shares)
    speed = np.linalg.norm(rates, axis=1) / duration_s
    scatter = float(np.linalg.norm((channel.values - values).std(axis=0)))
    piece_s, piece_samples = duration_s / smoothed.pieces, len(times_s) / smoothed.pieces
    noise = _NOISE_GAIN * scatter / (piece_s * float(np.sqrt(piece_samples)))
    return speed > max(_SHARE_OF_PEAK * float(speed.max()), channel.rest, noise)
