"""A loop like the control loop with nothing in it: `empty_loop.py SECONDS` prints how late each turn came, as JSON.

What it is late for is the machine's doing: other real-time processes, or a host that takes the
processor away. It prints `ready` before it starts; times are those of `time.monotonic`.
"""

from __future__ import annotations

import contextlib
import gc
import json
import os
import sys
import time

_PERIOD_S = 0.001
_PRIORITY = 20
_LONGEST_LAG_S = 0.05


def turns(seconds: float) -> tuple[list[float], list[float]]:
    """Return when each turn was due, and how late it came."""
    count = round(seconds / _PERIOD_S)
    dues, lates = [0.0] * count, [0.0] * count
    due = time.monotonic() + _PERIOD_S
    for turn in range(count):
        wait = due - time.monotonic()
        if wait > 0.0:
            time.sleep(wait)
        late = time.monotonic() - due
        dues[turn], lates[turn] = due, late
        due += late + _PERIOD_S if late > _LONGEST_LAG_S else _PERIOD_S
    return dues, lates


def main() -> None:
    """Run the loop with the schedule of the world's process, where that is permitted."""
    # Where it is refused, the world's process has the ordinary schedule too.
    with contextlib.suppress(OSError):
        os.sched_setscheduler(0, os.SCHED_FIFO, os.sched_param(_PRIORITY))
    gc.disable()
    print("ready", flush=True)
    dues, lates = turns(float(sys.argv[1]))
    print(json.dumps({"due_s": dues, "late_s": lates}), flush=True)


if __name__ == "__main__":
    main()
