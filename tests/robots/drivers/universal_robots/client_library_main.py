"""Calls of the client library of Universal Robots controllers, read as JSON lines and answered with JSON lines.

A process of its own: the library can crash, keeps the interpreter's lock while it waits, and prints what it likes.
"""

from __future__ import annotations

import importlib
import json
import os
import sys
from typing import Any

INTERFACES = {
    "control": ("rtde_control", "RTDEControlInterface"),
    "receive": ("rtde_receive", "RTDEReceiveInterface"),
    "io": ("rtde_io", "RTDEIOInterface"),
    "dashboard": ("dashboard_client", "DashboardClient"),
}


def servo(control: Any, start: list[float], step: list[float], cycles: int, period_s: float) -> int:
    """Send set points that move by `step` from one to the next."""
    for cycle in range(1, cycles + 1):
        begin = control.initPeriod()
        q = [angle + cycle * change for angle, change in zip(start, step, strict=True)]
        control.servoJ(q, 0.0, 0.0, period_s, 0.1, 300.0)
        control.waitPeriod(begin)
    return cycles


def kick(control: Any, kicks: int) -> int:
    """Tell the watchdog so often, once a period, that this process is alive."""
    for _ in range(kicks):
        begin = control.initPeriod()
        control.kickWatchdog()
        control.waitPeriod(begin)
    return kicks


def main() -> None:
    """Answer until the end of the input."""
    host = sys.argv[1]
    answers = os.fdopen(os.dup(1), "w", buffering=1)
    os.dup2(2, 1)
    interfaces: dict[str, Any] = {}
    for line in sys.stdin:
        request = json.loads(line)
        name, _, method = request["call"].partition(".")
        try:
            if method == "open":
                module, kind = INTERFACES[name]
                interfaces[name] = getattr(importlib.import_module(module), kind)(host, *request["arguments"])
                result = True
            elif name in ("servo", "kick"):
                result = globals()[name](interfaces["control"], *request["arguments"])
            else:
                result = getattr(interfaces[name], method)(*request["arguments"])
            answer = {"result": result}
        # Whatever the library raises is what the test wants to see.
        except Exception as error:
            answer = {"error": f"{type(error).__name__}: {error}"}
        answers.write(json.dumps(answer) + "\n")
    # Its destructors wait, and after a lost link they crash.
    os._exit(0)


if __name__ == "__main__":
    main()
