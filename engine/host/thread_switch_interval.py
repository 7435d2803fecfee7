"""Shortens Python's thread switch interval, so that the event loop stays responsive beside busy threads.

Python passes the interpreter lock on when a thread has waited for an interval, by default 5 ms, in which no thread
released it. A thread that releases it briefly, as every file access does, mostly gets it back at once, and the interval
starts again: several intervals pass before the loop runs.
"""

from __future__ import annotations

import sys
from collections.abc import Generator
from contextlib import contextmanager

INTERVAL_S = 0.001
"""A switch takes some microseconds, so that busy threads lose less than one percent."""


@contextmanager
def short_switch_interval() -> Generator[None]:
    """Shorten the interval while the block runs; a shorter interval is kept."""
    previous_s = sys.getswitchinterval()
    sys.setswitchinterval(min(previous_s, INTERVAL_S))
    try:
        yield
    finally:
        sys.setswitchinterval(previous_s)
