"""Shared services of the nodes of one run: time, bus, recorder, gate, random numbers, counters."""

from __future__ import annotations

import asyncio
import random
from collections.abc import Awaitable, Callable
from dataclasses import dataclass, field
from typing import Any, Protocol, TypeVar

from engine.bus import SkillBus
from engine.clock import Clock, OneTurn
from engine.document.duration import LONGEST_S
from engine.document.expression.expression_cost import MAX_STEPS
from engine.document.expression.step_meter import METER
from engine.errors import StateError
from engine.event import NodeAbandoned, UserdataAppended, UserdataWritten
from engine.runtime.control.gate import Gate
from engine.runtime.record.node_checkpoint import NodeCheckpoint
from engine.runtime.record.recorder import Recorder
from engine.runtime.record.skill_port import SkillPort
from engine.runtime.scheduling.active_nodes import ActiveNodes
from engine.runtime.scheduling.hold import BranchHolds
from engine.runtime.scheduling.observed_answers import ObservedAnswers
from engine.runtime.scheduling.pending_calls import PendingCalls
from engine.runtime.scheduling.settlement import Settlement
from engine.runtime.scheduling.wait_counters import WaitCounter
from engine.runtime.userdata.active_scopes import ActiveScopes
from engine.runtime.userdata.userdata import Scope
from engine.runtime.userdata.userdata_value import plain_value

N = TypeVar("N")


class BranchContainer(Protocol):
    """A container with branches, as a hot change accesses it."""

    def merge(self, name: str) -> None:
        """Write the values of a branch to the enclosing scopes that own the keys."""
        ...

    def wake(self) -> None:
        """Apply changes in `Execution.replaced`."""
        ...


@dataclass(kw_only=True)
class Execution:
    """One execution of one behavior; shared by its nodes, owned by the run, used on the loop thread."""

    run: str
    bus: SkillBus
    clock: Clock
    recorder: Recorder
    random: random.Random
    skills: SkillPort
    branch_holds: BranchHolds
    gate: Gate
    loop: asyncio.AbstractEventLoop = field(default_factory=asyncio.get_running_loop)
    """The event loop of the run."""
    activity: ActiveNodes = field(default_factory=ActiveNodes)
    instant_limit: int = 10_000
    """Consecutive transitions without a wait before an endless loop is reported."""
    polling_limit: int = 20_000
    """Consecutive transitions of a loop in virtual time that only wait, before a livelock is reported."""
    progress_count: int = 0
    """Number of writes and requests that the next step of a state may depend on."""
    abandon_after_s: float = 30.0
    """Maximum time until a preempted node confirms its stop, before the run abandons it."""
    waits: WaitCounter = field(default_factory=WaitCounter)
    settlement: Settlement = field(default_factory=Settlement)
    pending_calls: PendingCalls = field(default_factory=PendingCalls)
    observed: ObservedAnswers = field(default_factory=ObservedAnswers)
    scopes: ActiveScopes = field(default_factory=ActiveScopes)
    visits: dict[str, int] = field(default_factory=dict[str, int])
    points: dict[str, NodeCheckpoint] = field(default_factory=dict[str, NodeCheckpoint])
    """Checkpoints of the nodes that are resumed; each is taken once."""
    world: Callable[[], Awaitable[bytes | None]] | None = None
    """Returns the state of the simulated world, stored with every commit."""
    is_resumed: bool = False
    """Whether the checkpoints belong to this run, whose events already describe how they were reached."""

    steps: float = 0.0
    """Expression steps, and work done for expressions, since other tasks on the loop last had a turn.

    Above `MAX_STEPS` they `yield_turn`.
    """
    replaced: dict[str, object] = field(default_factory=dict[str, object])
    """Nodes and containers replaced by a hot change, by path; containers under `path/`."""
    branching: dict[str, BranchContainer] = field(default_factory=dict[str, "BranchContainer"])
    """The active containers whose branches a hot change may add and remove, by path."""
    abandoned: dict[str, asyncio.Task[Any]] = field(default_factory=dict[str, "asyncio.Task[Any]"])
    """Tasks that did not end when preempted; no task waits for them."""

    @property
    def needs_slow_path(self) -> bool:
        """Whether a node needs more than its run: the gate is armed, it is resumed or replaced, or a turn is due."""
        return bool(self.gate.armed or self.points or self.replaced or self.steps > MAX_STEPS)

    def counted(self) -> _Counted:
        """Return a context manager that counts the steps of the code inside, which must not wait."""
        return _Counted(self)

    async def yield_turn(self) -> None:
        """Give other tasks on the loop a turn, and the journal writer; due by step count, so that runs repeat.

        Raises:
            JournalError: the journal can no longer be written.
        """
        self.steps = 0.0
        await asyncio.sleep(0)
        await self.recorder.apply_backpressure()

    def abandon(self, task: asyncio.Task[Any] | None, path: str, waited_s: float) -> None:
        """Abandon a task that does not end; its leases are kept."""
        self.recorder.emit(NodeAbandoned, path=path, waited_s=waited_s)
        if task is not None:
            self.abandoned[path] = task

    async def commit(self) -> None:
        """Make all recorded events durable, with the state of the simulated world; required before any effect.

        Raises:
            JournalError: it cannot be written; the run must stop.
        """
        if self.world is not None:
            state = await self.world()
            if state is not None:
                self.recorder.append_world_state(state)
        await self.recorder.commit()

    def point(self, path: str) -> NodeCheckpoint | None:
        """Take the checkpoint from which the node is resumed, if any."""
        return self.points.pop(path, None) if self.points else None

    def latest(self, path: str, node: N) -> N:
        """Return the current definition of a node, which a hot change may have replaced."""
        if not self.replaced:
            return node
        replacement = self.replaced.get(path)
        return replacement if isinstance(replacement, type(node)) else node

    def write(self, path: str, scope: Scope, key: str, value: object, *, post: str = "") -> None:
        """Write to the scope that owns the key, as seen from `scope`, and record the write.

        Raises:
            UserdataError: the value cannot be stored without change.
        """
        plain = plain_value(value, key=key, where=path)
        with self.counted():
            owner = scope.write(key, value)
        self.record_write(path, owner, key, plain, post=post)

    def append(self, path: str, scope: Scope, key: str, value: object) -> int:
        """Append a value, which no one else may hold, to a list as seen from `scope`, and record the write.

        Returns:
            The new length of the list.

        Raises:
            UserdataError: the value cannot be stored without change, or `key` is not a list.
        """
        plain = plain_value(value, key=key, where=path)
        with self.counted():
            owner, values, is_new = scope.append(key, value, writer=path)
        if is_new:
            self.record_write(path, owner, key, plain_value(values, key=key, where=path))
        else:
            self.progress_count += 1
            self.recorder.emit(UserdataAppended, path=path, scope=owner, key=key, value=plain)
        return len(values)

    def record_write(self, path: str, scope: str, key: str, value: object, *, post: str = "") -> None:
        """Record that the node at `path`, or a post-condition of it, wrote a plain value to `key` of `scope`."""
        self.progress_count += 1
        self.recorder.emit(UserdataWritten, path=path, scope=scope, key=key, value=value, post=post)

    async def sleep(self, path: str, duration_s: float) -> None:
        """Wait for `duration_s`, excluding the time in which the branch of `path` is held.

        Raises:
            StateError: the duration is too long or not a number.
        """
        if not duration_s <= LONGEST_S:
            raise StateError(f"cannot wait for {duration_s:g} s", where=path, hint=f"wait at most {LONGEST_S:g} s")
        if duration_s <= 0:
            await OneTurn()
            return
        self.waits.add_timed(path, duration_s)
        timer = self.branch_holds.timer(path, duration_s)
        try:
            await timer.future
        finally:
            self.branch_holds.drop(timer)


class _Counted:
    """Counts the steps inside; a class, as a generator costs three times as much and every read uses it."""

    __slots__ = ("_before", "_execution")

    def __init__(self, execution: Execution) -> None:
        self._execution = execution
        self._before = 0.0

    def __enter__(self) -> None:
        self._before = METER.worked

    def __exit__(self, *_: object) -> None:
        self._execution.steps += METER.worked - self._before
