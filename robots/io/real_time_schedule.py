"""The real-time schedule of control processes."""

from __future__ import annotations

import os

_FIFO_PRIORITY = 20


def take_real_time_schedule() -> bool:
    """Request SCHED_FIFO; returns False, and keeps the default schedule, if the system does not permit it."""
    try:
        os.sched_setscheduler(0, os.SCHED_FIFO, os.sched_param(_FIFO_PRIORITY))
    except (AttributeError, OSError):
        return False
    return True
