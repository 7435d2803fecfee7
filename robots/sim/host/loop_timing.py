"""Timing statistics of a real-time loop: lateness histogram, overruns, skipped time."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from robots.port import Array

_BUCKET_S = 5e-6
_BUCKETS = 4000
_FIELDS = 4
_MAX = 3
SIZE = _FIELDS + _BUCKETS


@dataclass(frozen=True, kw_only=True)
class LoopTiming:
    """Lateness is the delay of a wake-up after its due time; an overrun is a step that ended after the next due time.

    `slipped_s` is world time skipped because the machine stalled for too long.
    """

    steps: int
    overruns: int
    slipped_s: float
    late_p50_s: float
    late_p99_s: float
    late_max_s: float
    values: Array = field(repr=False, compare=False)
    """The raw values of the `TimingCounter`."""

    def since(self, earlier: LoopTiming) -> LoopTiming:
        """Return the statistics of the time after `earlier`, of the same loop.

        The maximum is exact to 5 µs only, unless it is the overall maximum.
        """
        values = self.values - earlier.values
        late_max_s = self.late_max_s
        if late_max_s <= earlier.late_max_s:
            counted = np.flatnonzero(values[_FIELDS:])
            last = int(counted[-1]) + 1 if len(counted) else 0
            late_max_s = min(last * _BUCKET_S, late_max_s)
        return decode_timing(values, late_max_s=late_max_s)


class TimingCounter:
    """Counts in the loop's own process; `decode_timing` reads `values`."""

    def __init__(self) -> None:
        self.values = np.zeros(SIZE)

    def count(self, *, late_s: float, overrun: bool) -> None:
        """Count one step."""
        values = self.values
        late_s = max(late_s, 0.0)
        values[0] += 1.0
        values[1] += overrun
        values[_MAX] = max(values[_MAX], late_s)
        values[_FIELDS + min(int(late_s / _BUCKET_S), _BUCKETS - 1)] += 1.0

    def slip(self, duration_s: float) -> None:
        """Count skipped world time."""
        self.values[2] += duration_s


def decode_timing(values: Array, *, late_max_s: float | None = None) -> LoopTiming:
    """Return the statistics of a counter's values, or of a sum of counters with another maximum."""
    histogram: Array = np.cumsum(values[_FIELDS:])
    return LoopTiming(
        steps=int(values[0]),
        overruns=int(values[1]),
        slipped_s=float(values[2]),
        late_p50_s=_share(histogram, 0.50),
        late_p99_s=_share(histogram, 0.99),
        late_max_s=float(values[_MAX]) if late_max_s is None else late_max_s,
        values=values.copy(),
    )


def _share(cumulated: Array, share: float) -> float:
    """Return the upper edge of the bucket in or below which `share` of the counts lie."""
    if cumulated[-1] == 0.0:
        return 0.0
    bucket = int(np.searchsorted(cumulated, share * float(cumulated[-1])))
    return (bucket + 1) * _BUCKET_S
