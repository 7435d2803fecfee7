"""Shortens Python's thread switch interval, so that the event loop stays responsive beside busy threads.

Python hands the interpreter over when a thread has waited for an interval, by default 5 ms, in which nobody gave it up.
A thread that gives it up for a moment, as each look at a file does, mostly has it back at once, and the interval begins
anew: several of them go by before the loop has its turn.
"""

from __future__ import annotations

import sys
from collections.abc import Generator
from contextlib import contextmanager

INTERVAL_S = 0.001
"""Handing over takes some microseconds, so that threads which work lose less than one percent by it."""


@contextmanager
def short_switch_interval() -> Generator[None]:
    """Shorten the interval inside; a shorter one stays."""
    before = sys.getswitchinterval()
    sys.setswitchinterval(min(before, INTERVAL_S))
    try:
        yield
    finally:
        sys.setswitchinterval(before)
