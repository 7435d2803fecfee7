"""SMACH-like: our own stand-in for SMACH's execution model, as SMACH itself is not on PyPI.

One lock is handed over around every state, userdata passes through a view of declared keys, and a
concurrence starts a thread for each child and waits for all. It lacks SMACH's logging and callbacks.
"""

from __future__ import annotations

import queue
import threading
import time
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Protocol

from benchmarks.sample import Reactions, Sample, Stopwatch

_OUTCOMES = ("done", "again")


class _State(Protocol):
    def execute(self, userdata: _View) -> str: ...


@dataclass(frozen=True)
class _View:
    """What a state sees of its container's userdata: the declared keys, renamed."""

    userdata: dict[str, object]
    input_keys: tuple[str, ...] = ()
    output_keys: tuple[str, ...] = ()
    remapping: Mapping[str, str] = field(default_factory=dict[str, str])


@dataclass(frozen=True)
class _Callback:
    """A state whose work is a function that returns its outcome."""

    work: Callable[[], str]

    def execute(self, userdata: _View) -> str:
        return self.work()


class _StateMachine:
    def __init__(self, states: Mapping[str, tuple[_State, Mapping[str, str]]], outcomes: tuple[str, ...]) -> None:
        self._states = states
        self._outcomes = outcomes
        self._transitioning = threading.Lock()
        self._preempted = threading.Event()

    def execute(self, userdata: _View) -> str:
        """Run from the first state to an outcome."""
        own: dict[str, object] = {key: userdata.userdata[key] for key in userdata.input_keys}
        label = next(iter(self._states))
        with self._transitioning:
            while True:
                label = self._step(label, own)
                if label in self._outcomes:
                    return label

    def _step(self, label: str, own: dict[str, object]) -> str:
        state, transitions = self._states[label]
        if self._preempted.is_set():
            return "preempted"
        # A preempt from another thread must be able to get in while the state runs.
        self._transitioning.release()
        try:
            outcome = state.execute(_View(own))
        finally:
            self._transitioning.acquire()
        if outcome not in _OUTCOMES:
            raise ValueError(f"state {label} returned {outcome!r}")
        target = transitions[outcome]
        if target not in self._states and target not in self._outcomes:
            raise ValueError(f"{target!r} is neither a state nor an outcome")
        return target


class _Concurrence:
    def __init__(self, states: Mapping[str, _State]) -> None:
        self._states = states

    def execute(self, userdata: _View) -> str:
        """Run every state in a thread of its own and wait for all."""
        ready, outcomes = threading.Event(), dict[str, str]()

        def run(label: str, state: _State) -> None:
            ready.wait()
            outcomes[label] = state.execute(userdata)

        threads = [threading.Thread(target=run, args=item) for item in self._states.items()]
        for thread in threads:
            thread.start()
        ready.set()
        for thread in threads:
            thread.join()
        return "done" if all(outcomes[label] == "done" for label in self._states) else "failed"


def chain(watch: Stopwatch, states: int) -> Sample:
    """A state machine of states that end at once."""
    machine = _machine(states)
    return watch.measure(states, lambda: machine.execute(_View({})))


def branches(watch: Stopwatch, count: int, states: int) -> Sample:
    """A concurrence of state machines, a thread each."""
    root = _Concurrence({f"c{i}": _machine(states) for i in range(count)})
    return watch.measure(count * states, lambda: root.execute(_View({})))


def reaction(watch: Stopwatch, events: int) -> Sample:
    """A state that blocks in its thread on a queue until another thread puts something in."""
    inbox: queue.Queue[str] = queue.Queue()
    reactions = Reactions(events, lambda: inbox.put("go"))

    def wait() -> str:
        reactions.waiting()
        inbox.get()
        return "done"

    machine = _StateMachine(
        {
            "wait": (_Callback(wait), {"done": "mark"}),
            "mark": (_Callback(lambda: "done" if reactions.entered() else "again"), {"done": "end", "again": "wait"}),
        },
        ("end",),
    )
    machine.execute(_View({}))
    return reactions.sample()


def idle(watch: Stopwatch, children: int, duration_ms: int) -> Sample:
    """A concurrence whose threads block on an event that does not come."""
    event = threading.Event()

    def wait() -> str:
        event.wait()
        return "done"

    root = _Concurrence({f"c{i}": _Callback(wait) for i in range(children)})
    runner = threading.Thread(target=root.execute, args=(_View({}),))
    runner.start()
    time.sleep(0.2)
    cpu_s, wall_s = time.process_time(), time.perf_counter()
    time.sleep(duration_ms / 1000)
    sample = Sample(1, time.process_time() - cpu_s, time.perf_counter() - wall_s)
    event.set()
    runner.join()
    return sample


def _machine(states: int) -> _StateMachine:
    step = _Callback(lambda: "done")
    targets = [*(f"s{i}" for i in range(1, states)), "done"]
    return _StateMachine({f"s{i}": (step, {"done": target}) for i, target in enumerate(targets)}, ("done",))
