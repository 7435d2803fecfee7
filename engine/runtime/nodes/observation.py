"""Evaluates the outcome that a state would have now, without side effects: no event, userdata, wait or command.

A behavior tree observes the checks in front of a running action. Service answers of an observation are stored for the
state itself, which sends the same requests in the tick that follows: both use one answer.
"""

from __future__ import annotations

import asyncio
from collections.abc import Callable
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
from engine.skills.goal_end import GoalEnd
from engine.state import Outcome

R = TypeVar("R")
F = TypeVar("F")
S = TypeVar("S", bound=msgspec.Struct)


class Observation(msgspec.Struct, frozen=True):
    """Exit that a leaf would have, the service answers to its state, and the topics it read.

    `left` is None where only a run determines it, for instance because the state raises.
    """

    left: NodeExit | None = None
    answers: tuple[ObservedAnswer, ...] = ()
    topics: frozenset[str] = frozenset()


async def observe(node: Node, scope: Scope, execution: Execution) -> Observation:
    """Return the exit that a leaf would have now.

    This is possible for a state that reads userdata, topics and the time, and for one that calls services where its
    class declares `observes`. Run it in a separate task.
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
        # A run raises the same error, where a decorator or `on_error` may handle it.
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
    except BaseException:  # noqa: S110 - as above: a BaseException is also an error of the node once it runs
        pass
    left = NodeExit(outcome.name) if isinstance(outcome, Outcome) and outcome.name in work.outcomes else None
    return Observation(left, tuple(context.answers), frozenset(context.topics))


class ObservingContext:
    """The `engine.state.Context` of a state under observation.

    Waits, commands and visible effects are refused: like a preemption, they raise CancelledError.

    Args:
        execution: The run.
        path: The path of the leaf.
        asks: Whether it may call services.
    """

    def __init__(self, execution: Execution, path: str, *, asks: bool) -> None:
        self.path = path
        self.answers: list[ObservedAnswer] = []
        self.topics: set[str] = set()
        self._execution = execution
        self._asks = asks

    @property
    def clock(self) -> Clock:
        """The clock of the run, without sleep."""
        return _ReadOnlyClock(self._execution.clock)

    async def call(self, request: Service[R], *, to: str) -> R:
        """Call a service, where the class declares that this has no effect."""
        if not self._asks:
            raise asyncio.CancelledError
        try:
            answer = await self._execution.skills.call(request, to=to, holder=self._holder)
        except FlexcellError as error:
            self.answers.append(ObservedAnswer(request, to, error=error))
            raise
        self.answers.append(ObservedAnswer(request, to, answer))
        return answer

    async def perform(self, goal: Action[R, F], *, to: str) -> GoalEnd[R]:
        """Refuse: an observation sends no goals."""
        raise asyncio.CancelledError

    async def latest(self, topic: str, kind: type[S]) -> S:
        """Return the latest message of a topic, waiting for the first one."""
        self.topics.add(topic)
        return await self._execution.skills.latest(topic, kind, holder=self._holder)

    async def next_message(self, topic: str, kind: type[S]) -> S:
        """Refuse: an observation does not wait."""
        raise asyncio.CancelledError

    async def latest_data(self, topic: str) -> object:
        """Return the latest message of a topic as plain data, waiting for the first one."""
        self.topics.add(topic)
        return await self._execution.skills.latest_data(topic, holder=self._holder)

    async def next_data(self, topic: str, condition: Callable[[object], bool]) -> object:
        """Refuse: an observation does not wait."""
        raise asyncio.CancelledError

    async def publish(self, topic: str, message: object) -> None:
        """Refuse: an observation has no effect."""
        raise asyncio.CancelledError

    async def offer(self, outcome: str) -> None:
        """Refuse: an observation requests no confirmation."""
        raise asyncio.CancelledError

    def log(self, message: str, *, level: str = "info") -> None:
        """Drop the message."""

    def random(self) -> float:
        """Refuse: a drawn number would change the numbers of later states."""
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
