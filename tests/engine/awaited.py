"""Waits for what other processes do without saying so: what they write to files, and that they end."""

from __future__ import annotations

import time
from collections.abc import Callable

_EVERY_S = 0.02
"""Looking all the time would take the processor from the process that is looked at."""
_LIMIT_S = 120.0


def wait_until(holds: Callable[[], bool]) -> None:
    """Wait until something holds; `holds` raises AssertionError where it cannot hold any more."""
    deadline_s = time.monotonic() + _LIMIT_S
    while not holds():
        assert time.monotonic() < deadline_s, f"it does not hold after {_LIMIT_S:g} s"
        time.sleep(_EVERY_S)
