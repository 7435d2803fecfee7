"""How punctual a world's process is, beside an empty loop that tells how punctual it could be on this machine."""

from __future__ import annotations

import asyncio
import json
import sys
import time
from asyncio.subprocess import PIPE
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise
from pathlib import Path

import numpy as np

from robots.port import Array
from robots.sim.host.loop_timing import LoopTiming, decode_timing
from robots.sim.host.process_host import ProcessHost

_LOOP = Path(__file__).with_name("empty_loop.py")
_WINDOW_S = 0.25
# The world tells its counts this seldom, so a window may hold what happened a little before it.
_BLUR_S = 0.06
_LATE_S = 0.001


@dataclass(frozen=True, kw_only=True)
class Punctuality:
    """`quiet` is of those windows alone in which the empty loop was never a millisecond late, None without any."""

    whole: LoopTiming
    quiet: LoopTiming | None
    quiet_share: float
    empty_p99_s: float
    empty_max_s: float


async def watch(host: ProcessHost, seconds: float) -> Punctuality:
    """Watch a world for so long."""
    loop = await asyncio.create_subprocess_exec(
        sys.executable, "-I", _LOOP, str(seconds + 0.5), stdout=PIPE, stdin=PIPE
    )
    assert loop.stdout is not None
    await loop.stdout.readline()
    marks = [(time.monotonic(), host.timing())]
    end_s = marks[0][0] + seconds
    while marks[-1][0] < end_s:
        await asyncio.sleep(_WINDOW_S)
        marks.append((time.monotonic(), host.timing()))
    output, _ = await loop.communicate()
    empty = json.loads(output)
    due_s, late_s = np.array(empty["due_s"]), np.array(empty["late_s"])
    quiet = [
        after.since(before)
        for (start_s, before), (stop_s, after) in pairwise(marks)
        if not _disturbed(due_s, late_s, start_s - _BLUR_S, stop_s)
    ]
    within = late_s[(due_s >= marks[0][0]) & (due_s <= marks[-1][0])]
    return Punctuality(
        whole=marks[-1][1].since(marks[0][1]),
        quiet=merged(quiet) if quiet else None,
        quiet_share=len(quiet) / (len(marks) - 1),
        empty_p99_s=float(np.quantile(within, 0.99)),
        empty_max_s=float(within.max()),
    )


def merged(timings: Sequence[LoopTiming]) -> LoopTiming:
    """Return the figures of several times of one loop together."""
    values = np.sum([timing.values for timing in timings], axis=0)
    greatest = max(timing.late_max_s for timing in timings)
    return decode_timing(values, late_max_s=greatest)


def _disturbed(due_s: Array, late_s: Array, start_s: float, stop_s: float) -> bool:
    """Return whether a turn of the empty loop that was due, or came, in a window was late."""
    met = (due_s <= stop_s) & (due_s + late_s >= start_s)
    return bool((late_s[met] > _LATE_S).any())
