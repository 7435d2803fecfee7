"""python-statemachine: classes made from definitions; an event for every step, of all parallel regions at once."""

from __future__ import annotations

import queue
from typing import Any

import statemachine.io

from benchmarks.sample import Reactions, Sample, Stopwatch


def chain(watch: Stopwatch, states: int) -> Sample:
    """One event for each transition."""
    machine = _machine("Chain", _ring(states))
    return watch.measure(states, lambda: _send(machine, states))


def branches(watch: Stopwatch, count: int, states: int) -> Sample:
    """A parallel state whose regions all take a step at each event."""
    regions: dict[str, Any] = {f"c{i}": {"states": _ring(2, prefix=f"c{i}_")} for i in range(count)}
    parallel: Any = {"all": {"parallel": True, "initial": True, "states": regions}}
    machine = _machine("Parallel", parallel)
    return watch.measure(count * states, lambda: _send(machine, states))


def reaction(watch: Stopwatch, events: int) -> Sample:
    """A thread waits on a queue and sends what it gets; the next state's callback takes the time."""
    inbox: queue.Queue[str] = queue.Queue()
    reactions = Reactions(events, lambda: inbox.put("go"))
    last: list[bool] = [False]

    def entered() -> None:
        last[0] = reactions.entered()

    definition: Any = {
        "wait": {"initial": True, "on": {"go": [{"target": "mark"}]}},
        "mark": {"enter": entered, "on": {"back": [{"target": "wait"}]}},
    }
    machine = _machine("Reaction", definition)
    while not last[0]:
        reactions.waiting()
        machine.send(inbox.get())
        machine.send("back")
    return reactions.sample()


def _ring(states: int, *, prefix: str = "s") -> Any:
    """States in a circle, so that the machine can be driven round again and again."""
    return {
        f"{prefix}{i}": {"initial": i == 0, "on": {"go": [{"target": f"{prefix}{(i + 1) % states}"}]}}
        for i in range(states)
    }


def _machine(name: str, states: Any) -> Any:
    """Make the class and one machine of it; the library is typed in part, so it is `Any` from here on."""
    make: Any = statemachine.io.create_machine_class_from_definition  # pyright: ignore[reportUnknownMemberType, reportUnknownVariableType]
    return make(name, states)()


def _send(machine: Any, times: int) -> None:
    for _ in range(times):
        machine.send("go")
