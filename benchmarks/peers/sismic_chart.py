"""sismic: a YAML statechart and its interpreter; the runner of the library polls for events."""

from __future__ import annotations

import threading
import time
from typing import Any

from sismic.interpreter import Interpreter
from sismic.io import import_from_yaml  # pyright: ignore[reportUnknownVariableType] # partly typed
from sismic.runner import AsyncRunner

from benchmarks.sample import Reactions, Sample, Stopwatch

_INTERVAL_S = 0.1
"""How often the runner looks for events by default."""


def chain(watch: Stopwatch, states: int) -> Sample:
    """One event for each transition."""
    children = _ring(states, prefix="s", indent="    ")
    interpreter = _interpreter(f"  root state:\n    name: root\n    initial: s0\n    states:\n{children}")
    return watch.measure(states, lambda: _drive(interpreter, states))


def branches(watch: Stopwatch, count: int, states: int) -> Sample:
    """A parallel state whose regions all take a step at each event."""
    regions = "".join(
        f"    - name: c{i}\n      initial: c{i}_0\n      states:\n{_ring(states, prefix=f'c{i}_', indent='      ')}"
        for i in range(count)
    )
    interpreter = _interpreter(f"  root state:\n    name: root\n    parallel states:\n{regions}")
    return watch.measure(count * states, lambda: _drive(interpreter, states))


def reaction(watch: Stopwatch, events: int) -> Sample:
    """An event queued by another thread is seen at the runner's next look."""
    done = threading.Event()
    started: list[Reactions] = []

    def entered() -> None:
        if started[0].entered():
            done.set()
        else:
            started[0].waiting()

    interpreter = _interpreter(
        "  root state:\n    name: root\n    initial: wait\n    states:\n"
        "    - name: wait\n      transitions:\n      - event: go\n        target: mark\n"
        "    - name: mark\n      on entry: entered()\n      transitions:\n      - target: wait\n",
        entered=entered,
    )
    started.append(Reactions(events, lambda: interpreter.queue("go") and None, spread_s=_INTERVAL_S))
    runner = AsyncRunner(interpreter, interval=_INTERVAL_S)
    runner.start()
    started[0].waiting()
    done.wait()
    runner.stop()
    return started[0].sample()


def idle(watch: Stopwatch, duration_ms: int) -> Sample:
    """One waiting chart under the library's runner."""
    interpreter = _interpreter("  root state:\n    name: root\n    initial: s0\n    states:\n    - name: s0\n")
    runner = AsyncRunner(interpreter, interval=_INTERVAL_S)
    runner.start()
    cpu_s, wall_s = time.process_time(), time.perf_counter()
    time.sleep(duration_ms / 1000)
    sample = Sample(1, time.process_time() - cpu_s, time.perf_counter() - wall_s)
    runner.stop()
    return sample


def _ring(states: int, *, prefix: str, indent: str) -> str:
    """States in a circle, so that the chart can be driven round again and again."""
    return "".join(
        f"{indent}- name: {prefix}{i}\n{indent}  transitions:\n"
        f"{indent}  - event: go\n{indent}    target: {prefix}{(i + 1) % states}\n"
        for i in range(states)
    )


def _interpreter(root: str, **context: Any) -> Any:
    interpreter: Any = Interpreter(import_from_yaml(f"statechart:\n  name: bench\n{root}"), initial_context=context)
    interpreter.execute()
    return interpreter


def _drive(interpreter: Any, times: int) -> None:
    for _ in range(times):
        interpreter.queue("go").execute_once()
