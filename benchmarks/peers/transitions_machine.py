"""transitions: the flat machine, and the hierarchical one with its parallel states; an event for every step."""

from __future__ import annotations

import queue
import threading
import time
from typing import Any

from transitions import Machine
from transitions.extensions import HierarchicalMachine

from benchmarks.sample import Reactions, Sample, Stopwatch


def chain(watch: Stopwatch, states: int) -> Sample:
    """One `trigger` for each transition of a flat machine."""
    return _chain(watch, Machine, states)


def hierarchical_chain(watch: Stopwatch, states: int) -> Sample:
    """The same with the machine class that knows nested states."""
    return _chain(watch, HierarchicalMachine, states)


def branches(watch: Stopwatch, count: int, states: int) -> Sample:
    """A parallel state whose regions all take a step at each trigger."""
    names = [f"s{i}" for i in range(states + 1)]
    moves = [["go", source, target] for source, target in zip(names, [*names[1:], names[0]], strict=True)]
    regions = [{"name": f"c{i}", "initial": "s0", "states": names, "transitions": moves} for i in range(count)]
    parallel: dict[str, Any] = {"name": "all", "parallel": regions}
    machine = HierarchicalMachine(states=[parallel], initial="all", auto_transitions=False)

    def work() -> None:
        for _ in range(states):
            machine.trigger("go")  # pyright: ignore[reportAttributeAccessIssue] # made at run time

    return watch.measure(count * states, work)


def reaction(watch: Stopwatch, events: int) -> Sample:
    """A thread waits on a queue and triggers what it gets; the next state's callback takes the time."""
    inbox: queue.Queue[str] = queue.Queue()
    reactions = Reactions(events, lambda: inbox.put("go"))
    last: list[bool] = [False]

    def entered() -> None:
        last[0] = reactions.entered()

    machine = Machine(states=["wait", {"name": "mark", "on_enter": [entered]}], initial="wait", auto_transitions=False)
    machine.add_transition("go", "wait", "mark")
    machine.add_transition("back", "mark", "wait")
    while not last[0]:
        reactions.waiting()
        machine.trigger(inbox.get())  # pyright: ignore[reportAttributeAccessIssue] # made at run time
        machine.trigger("back")  # pyright: ignore[reportAttributeAccessIssue]
    return reactions.sample()


def idle(watch: Stopwatch, children: int, duration_ms: int) -> Sample:
    """Machines have nothing that runs: the thread that would trigger them blocks on its queue."""
    machines = [Machine(states=["wait"], initial="wait", auto_transitions=False) for _ in range(children)]
    inbox: queue.Queue[str] = queue.Queue()
    waiter = threading.Thread(target=inbox.get)
    waiter.start()
    cpu_s, wall_s = time.process_time(), time.perf_counter()
    time.sleep(duration_ms / 1000)
    sample = Sample(1, time.process_time() - cpu_s, time.perf_counter() - wall_s)
    inbox.put(f"{len(machines)} machines are done")
    waiter.join()
    return sample


def _chain(watch: Stopwatch, kind: type[Machine], states: int) -> Sample:
    names = [f"s{i}" for i in range(states)]
    machine = kind(states=names, initial="s0", auto_transitions=False)
    for source, target in zip(names, [*names[1:], names[0]], strict=True):
        machine.add_transition("go", source, target)

    def work() -> None:
        for _ in range(states):
            machine.trigger("go")  # pyright: ignore[reportAttributeAccessIssue] # made at run time

    return watch.measure(states, work)
