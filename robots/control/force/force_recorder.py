"""Records means of offset and wrench over equal periods of a force-tracking motion."""

from __future__ import annotations

import numpy as np

from robots.port import Array, ForceRecord


class ForceRecorder:
    """Collects a `ForceRecord`; every row is the mean over `period_s`."""

    def __init__(self, period_s: float) -> None:
        self._period_s = period_s
        self._rows: list[Array] = []
        self._sum = np.zeros(13)
        self._count = 0
        self._since_s = 0.0

    def add(self, step_s: float, *, share: float, offset: Array, wrench: Array) -> None:
        """Add one control period; offset and wrench have shape (6,)."""
        self._sum[0] += share
        self._sum[1:7] += offset
        self._sum[7:] += wrench
        self._count += 1
        self._since_s += step_s
        if self._since_s > self._period_s - 0.5 * step_s:
            self._close()

    def record(self) -> ForceRecord:
        """Return the record."""
        if self._count:
            self._close()
        rows = np.array(self._rows).reshape(-1, 13)
        return ForceRecord.of(share=rows[:, 0], offset=rows[:, 1:7], wrench=rows[:, 7:])

    def _close(self) -> None:
        self._rows.append(self._sum / self._count)
        self._sum[:] = 0.0
        self._count, self._since_s = 0, 0.0
