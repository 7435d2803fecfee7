"""Where the CPU time of one `flexcell` command goes: `python -m benchmarks.cold_start_profile COMMAND ARGUMENT…`.

Runs the command in this process and prints, as the last line, the CPU seconds of each span as JSON. A span counts
without those inside it: an import counts as one wherever it happens, and what is in none of them is the rest.
"""

from __future__ import annotations

import builtins
import functools
import importlib
import inspect
import json
import sys
import time
from collections import defaultdict
from collections.abc import Callable
from contextlib import suppress
from typing import Any

STARTUP, IMPORTS, REST = "interpreter", "imports", "rest"
SPANS = {
    "engine.cli.commands.run:read_valid_behavior": "read and check",
    "engine.cli.commands.run:new_plan": "plan",
    "engine.cell.open_cell:OpenCell.__aenter__": "open the cell",
    "robots.sim.host.lockstep_host:LockstepHost.advance": "simulated seconds",
    "robots.arm.execution.arm_planner:ArmPlanner._run": "plan motions",
}
"""What is timed: module and function, as their callers look it up, and the name of its span."""


class Spans:
    """The CPU time of spans that may be inside one another."""

    def __init__(self) -> None:
        self.cpu_s = defaultdict[str, float](float, {STARTUP: time.process_time()})
        self._open = [REST]
        self._since_s = time.process_time()

    def enter(self, name: str) -> None:
        """Count for `name` from now on."""
        self._count()
        self._open.append(name)

    def leave(self) -> None:
        """Count for what is around it again."""
        self._count()
        self._open.pop()

    def is_importing(self) -> bool:
        """Return whether an import is in progress: those that it makes belong to it."""
        return self._open[-1] == IMPORTS

    def total(self) -> dict[str, float]:
        """Return the CPU seconds of each span so far."""
        self._count()
        return {name: round(cpu_s, 4) for name, cpu_s in self.cpu_s.items()}

    def around(self, function: Callable[..., Any], name: str) -> Callable[..., Any]:
        """Return a function, or a coroutine function, that is counted for `name`."""
        if inspect.iscoroutinefunction(function):

            @functools.wraps(function)
            async def timed_coroutine(*args: object, **options: object) -> Any:
                self.enter(name)
                try:
                    return await function(*args, **options)
                finally:
                    self.leave()

            return timed_coroutine

        @functools.wraps(function)
        def timed(*args: object, **options: object) -> Any:
            self.enter(name)
            try:
                return function(*args, **options)
            finally:
                self.leave()

        return timed

    def _count(self) -> None:
        now_s = time.process_time()
        self.cpu_s[self._open[-1]] += now_s - self._since_s
        self._since_s = now_s


def watch_imports(spans: Spans) -> None:
    """Count imports, and wrap each function of `SPANS` as soon as its module is there."""
    due = dict(SPANS)

    def counted(load: Callable[..., Any]) -> Callable[..., Any]:
        timed = spans.around(load, IMPORTS)

        def loaded(*args: object, **options: object) -> Any:
            if spans.is_importing():
                return load(*args, **options)
            module = timed(*args, **options)
            _wrap(due, spans)
            return module

        return loaded

    builtins.__import__ = counted(builtins.__import__)
    importlib.import_module = counted(importlib.import_module)


def _wrap(due: dict[str, str], spans: Spans) -> None:
    for place in [each for each in due if each.partition(":")[0] in sys.modules]:
        module, _, name = place.partition(":")
        *owners, last = name.split(".")
        owner = functools.reduce(getattr, owners, sys.modules[module])
        setattr(owner, last, spans.around(getattr(owner, last), due.pop(place)))


def main() -> None:
    """Run the command of the command line and print the spans."""
    spans = Spans()
    watch_imports(spans)
    sys.argv = ["flexcell", *sys.argv[1:]]
    entry = importlib.import_module("engine.cli.entry")
    with suppress(SystemExit):
        entry.main()
    print(json.dumps(spans.total()))


if __name__ == "__main__":
    main()
