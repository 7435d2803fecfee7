"""Evaluates how a state would end now, without side effects: no event, no userdata, no wait, no command.

A behavior tree does so with the checks in front of a running action. What an observation has heard from services is
kept for the state itself, which asks the same when the tree is ticked because of it: so both have one answer.
"""

from __future__ import annotations

import asyncio
from typing import TypeVar

import msgspec

from engine.bus import Holder
from engine.clock import Clock
from engine.errors import FlexcellError
from engine.preemption import being_cancelled
from engine.runtime.nodes.execution import Execution
from engine.runtime.nodes.leaf import Leaf
from engine.runtime.nodes.node import Node
from engine.runtime.record.node_exit import NodeExit, guard_closed_cause
from engine.runtime.scheduling.observed_answers import ObservedAnswer
from engine.runtime.userdata.userdata import Scope
from engine.skill import Action, Service
from engine.state import ActionEnd, Outcome

R = TypeVar("R")
F = TypeVar("F")
S = TypeVar("S", bound=msgspec.Struct)


class Observation(msgspec.Struct, frozen=True):
    """How a leaf would end, what its state was answered, and the topics that it read.

    `left` is None where only running it can tell, for instance because of what it would raise.
    """

    left: NodeExit | None = None
    answers: tuple[ObservedAnswer, ...] = ()
    topics: frozenset[str] = frozenset()


async def observe(node: Node, scope: Scope, execution: Execution) -> Observation:
    """Return how a leaf would end now.

    It can be told of a state that reads userdata, topics and the time, and of one that asks services where its class
    says that it `observes`. Run it in a task of its own.
    """
    node = execution.latest(node.path, node)
    work = node.work
    if not isinstance(work, Leaf):
        return Observation()
    try:
        if node.guard is not None and not node.is_open(node.guard, scope, execution):
            return Observation(NodeExit("", node.guard.target, reason=guard_closed_cause(node.path)))
        with execution.counted():
            entry = work.enter(scope)
    except Exception:
        # Whatever it is, running it meets the same, where a decorator or `on_error` may take it.
        return Observation()
    if entry.state is None:
        return Observation()
    context = ObservingContext(execution, node.path, asks=work.state.observes)
    outcome: object = None
    try:
        outcome = await entry.state.run(context, **entry.inputs)
    except GeneratorExit:
        raise
    except asyncio.CancelledError:
        if being_cancelled(execution.loop):
            raise
    except BaseException:
        # As above: also what is no Exception is an error of the node once it is run.
        pass
    left = NodeExit(outcome.name) if isinstance(outcome, Outcome) and outcome.name in work.outcomes else None
    return Observation(left, tuple(context.answers), frozenset(context.topics))


class ObservingContext:
    """The `engine.state.Context` of a state that is only to say how it would end.

    What would take time, command, or show to others is refused: as when it is preempted, CancelledError is raised.

    Args:
        execution: The run.
        path: The leaf.
        asks: Whether it may ask services.
    """

    def __init__(self, execution: Execution, path: str, *, asks: bool) -> None:
        self.path = path
        self.answers: list[ObservedAnswer] = []
        self.topics: set[str] = set()
        self._execution = execution
        self._asks = asks

    @property
    def clock(self) -> Clock:
        """The run's time, in which nothing is waited for."""
        return _ReadOnlyClock(self._execution.clock)

    async def call(self, request: Service[R], *, to: str) -> R:
        """Ask a service, where the class says that this has no effect."""
        if not self._asks:
            raise asyncio.CancelledError
        try:
            answer = await self._execution.skills.call(request, to=to, holder=self._holder)
        except FlexcellError as error:
            self.answers.append(ObservedAnswer(request, to, error=error))
            raise
        self.answers.append(ObservedAnswer(request, to, answer))
        return answer

    async def perform(self, goal: Action[R, F], *, to: str) -> ActionEnd[R]:
        """Command nothing."""
        raise asyncio.CancelledError

    async def latest(self, topic: str, kind: type[S]) -> S:
        """Return the newest message of a topic, waiting for the first one."""
        self.topics.add(topic)
        return await self._execution.skills.latest(topic, kind, holder=self._holder)

    async def next_message(self, topic: str, kind: type[S]) -> S:
        """Wait for nothing."""
        raise asyncio.CancelledError

    async def offer(self, outcome: str) -> None:
        """Ask nobody."""
        raise asyncio.CancelledError

    def log(self, message: str, *, level: str = "info") -> None:
        """Say nothing."""

    def random(self) -> float:
        """Take no number from the run's: the next state would be given another one."""
        raise asyncio.CancelledError

    @property
    def _holder(self) -> Holder:
        return Holder(self._execution.run, self.path)


class _ReadOnlyClock:
    def __init__(self, clock: Clock) -> None:
        self._clock = clock

    @property
    def virtual(self) -> bool:
        return self._clock.virtual

    def now_s(self) -> float:
        return self._clock.now_s()

    async def sleep(self, duration_s: float) -> None:
        raise asyncio.CancelledError
