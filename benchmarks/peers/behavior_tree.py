"""py_trees: the root is ticked with `tick_once`, without the walk that `BehaviourTree.tick` adds."""

from __future__ import annotations

import threading
import time

import py_trees
from py_trees.behaviour import Behaviour
from py_trees.common import ParallelPolicy, Status
from py_trees.composites import Parallel, Sequence

from benchmarks.sample import Reactions, Sample, Stopwatch

_PERIOD_S = 0.01
"""A usual tick period; the library's own examples use 0.1 to 0.5 s."""


class _Succeed(Behaviour):
    def update(self) -> Status:
        return Status.SUCCESS


class _Wait(Behaviour):
    def update(self) -> Status:
        return Status.RUNNING


class _Receive(Behaviour):
    def __init__(self, arrived: threading.Event, reactions: Reactions) -> None:
        super().__init__("receive")
        self._arrived = arrived
        self._reactions = reactions

    def initialise(self) -> None:
        self._arrived.clear()
        self._reactions.waiting()

    def update(self) -> Status:
        return Status.SUCCESS if self._arrived.is_set() else Status.RUNNING


class _Mark(Behaviour):
    done = False

    def __init__(self, reactions: Reactions) -> None:
        super().__init__("mark")
        self._reactions = reactions

    def update(self) -> Status:
        self.done = self._reactions.entered()
        return Status.SUCCESS


def chain(watch: Stopwatch, states: int) -> Sample:
    """A sequence with memory of leaves that succeed, in one tick."""
    root = _sequence(states)
    return watch.measure(states, lambda: _tick(root, Status.SUCCESS))


def branches(watch: Stopwatch, count: int, states: int) -> Sample:
    """A parallel of sequences, in one tick."""
    root = _parallel([_sequence(states) for _ in range(count)])
    return watch.measure(count * states, lambda: _tick(root, Status.SUCCESS))


def ticks(watch: Stopwatch, children: int, times: int) -> Sample:
    """A parallel of leaves that go on running, ticked again and again."""
    root = _parallel([_Wait(f"wait {i}") for i in range(children)])

    def work() -> None:
        for _ in range(times):
            _tick(root, Status.RUNNING)

    return watch.measure(children * times, work)


def reaction(watch: Stopwatch, events: int) -> Sample:
    """A flag set by another thread is seen at the next tick."""
    arrived = threading.Event()
    reactions = Reactions(events, arrived.set, spread_s=_PERIOD_S)
    mark = _Mark(reactions)
    root = Sequence("root", memory=True, children=[_Receive(arrived, reactions), mark])
    while not mark.done:
        root.tick_once()
        time.sleep(_PERIOD_S)
    return reactions.sample()


def idle(watch: Stopwatch, children: int, duration_ms: int) -> Sample:
    """Waiting leaves, ticked at the usual period."""
    root = _parallel([_Wait(f"wait {i}") for i in range(children)])
    cpu_s, wall_s = time.process_time(), time.perf_counter()
    while time.perf_counter() - wall_s < duration_ms / 1000:
        root.tick_once()
        time.sleep(_PERIOD_S)
    return Sample(1, time.process_time() - cpu_s, time.perf_counter() - wall_s)


def _sequence(states: int) -> Sequence:
    return Sequence("chain", memory=True, children=[_Succeed(f"s{i}") for i in range(states)])


def _parallel(children: list[Behaviour] | list[Sequence]) -> Parallel:
    return Parallel("all", policy=ParallelPolicy.SuccessOnAll(synchronise=False), children=list(children))


def _tick(root: py_trees.behaviour.Behaviour, due: Status) -> None:
    root.tick_once()
    if root.status is not due:
        raise AssertionError(f"the tree is {root.status}, not {due}")
