"""Heartbeats between the engine and a control process: two counters in shared memory, and silence detection.

The engine increments its counter from its event loop, so a blocked, suspended or dead engine is silent. The
control process increments its own once per control period. Neither waits for the other: each compares a number.
`control_process` documents the contract of a control process, simulated or real.
"""

from __future__ import annotations

import mmap
import os
from pathlib import Path
from typing import Self

import numpy as np
from numpy.typing import NDArray

from robots.port.shared_file import new_shared_file

ENGINE_SILENCE_S = 0.2
"""Silence of the engine after which a control process brings everything to rest."""
CONTROL_SILENCE_S = 0.25
"""Silence of the control process after which the engine declares it lost; 0.3 s with one more look."""
PULSE_S = 0.02
"""Period of the engine's pulse and of its looks at the peer."""

_NAME = "flexcell-heartbeat"
_ENGINE, _CONTROL, _REST_SINCE, _SLOTS = 0, 1, 2, 3


def new_heartbeat_file() -> int:
    """Return the descriptor of an unnamed file for one heartbeat."""
    descriptor = new_shared_file(_NAME)
    os.ftruncate(descriptor, 8 * _SLOTS)
    return descriptor


class Heartbeat:
    """The counters of one connection between the engine and a control process; each has one writer.

    A count of 0 means that this side has not started yet.
    """

    def __init__(self, descriptor: int) -> None:
        self._memory = mmap.mmap(descriptor, 8 * _SLOTS)
        self._numbers: NDArray[np.int64] = np.frombuffer(self._memory, dtype=np.int64, count=_SLOTS)

    @classmethod
    def of_process(cls, pid: int) -> Self:
        """Open the heartbeat of a running control process, for a third process that only reads.

        Raises:
            OSError: there is no such process, it belongs to another user, or it has no heartbeat.
        """
        for entry in Path(f"/proc/{pid}/fd").iterdir():
            try:
                if _NAME not in str(entry.readlink()):
                    continue
            except FileNotFoundError:
                # The process has closed it meanwhile.
                continue
            descriptor = os.open(entry, os.O_RDWR)
            try:
                return cls(descriptor)
            finally:
                os.close(descriptor)
        raise FileNotFoundError(f"process {pid} has no heartbeat")

    @property
    def engine_count(self) -> int:
        """Number of pulses of the engine's loop."""
        return int(self._numbers[_ENGINE])

    @property
    def control_count(self) -> int:
        """Number of control periods."""
        return int(self._numbers[_CONTROL])

    @property
    def at_rest_since_ns(self) -> int:
        """Time on CLOCK_MONOTONIC since which everything is at rest without a motion; 0 otherwise."""
        return int(self._numbers[_REST_SINCE])

    def beat_engine(self) -> None:
        """Increment the engine's counter; called by the engine only."""
        self._numbers[_ENGINE] += 1

    def beat_control(self) -> None:
        """Increment the control process's counter; called by the control process only."""
        self._numbers[_CONTROL] += 1

    def report_at_rest(self, since_ns: int) -> None:
        """Report since when everything is at rest, 0 for not at rest; called by the control process only."""
        self._numbers[_REST_SINCE] = since_ns

    def close(self) -> None:
        """Release the memory."""
        del self._numbers
        self._memory.close()


class SilenceMonitor:
    """Measures how long a peer's counter has not changed, counting only time in which the observer itself ran.

    A gap between two looks counts for at most `longest_gap_s`: an observer that was itself suspended or
    blocked looks again before it decides. The first count above 0 arms it.

    Args:
        limit_s: Silence from which on the peer is `silent`.
        longest_gap_s: Maximum contribution of one gap between two looks; below the limit.
    """

    def __init__(self, *, limit_s: float, longest_gap_s: float) -> None:
        self._limit_s = limit_s
        self._longest_gap_s = min(longest_gap_s, limit_s / 2.0)
        self._count: int = 0
        self._looked_s = 0.0
        self.silent_s = 0.0

    @property
    def silent(self) -> bool:
        """Whether the peer has been silent for the limit."""
        return self.silent_s >= self._limit_s

    def look(self, count: int, now_s: float) -> bool:
        """Take the peer's present count; return whether it is silent."""
        gap_s, self._looked_s = now_s - self._looked_s, now_s
        if count != self._count or count == 0:
            self._count, self.silent_s = count, 0.0
        else:
            self.silent_s += min(max(gap_s, 0.0), self._longest_gap_s)
        return self.silent
