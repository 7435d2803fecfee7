"""What the nodes of one run share: time, bus, recorder, gate, random numbers, counters."""

from __future__ import annotations

import asyncio
import random
from collections.abc import Awaitable, Callable
from dataclasses import dataclass, field
from typing import Any, Protocol, TypeVar

from engine.bus import SkillBus
from engine.clock import Clock, OneTurn
from engine.document.duration import LONGEST_S
from engine.document.expression_cost import MAX_STEPS
from engine.document.step_meter import METER
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
from engine.runtime.userdata.userdata import Scope
from engine.runtime.userdata.userdata_value import plain_value

N = TypeVar("N")


class BranchContainer(Protocol):
    """A container with branches, at a hot change."""

    def merge(self, name: str) -> None:
        """Write what a branch has written where the keys live around it."""
        ...

    def wake(self) -> None:
        """Look at `Execution.replaced` again."""
        ...


@dataclass(kw_only=True)
class Execution:
    """One execution of one behavior, as its nodes see it; owned by the run, used on the loop thread."""

    run: str
    bus: SkillBus
    clock: Clock
    recorder: Recorder
    random: random.Random
    skills: SkillPort
    branch_holds: BranchHolds
    gate: Gate
    loop: asyncio.AbstractEventLoop = field(default_factory=asyncio.get_running_loop)
    """The one that it runs on."""
    activity: ActiveNodes = field(default_factory=ActiveNodes)
    instant_limit: int = 10_000
    """Transitions in a row in which nothing is waited for, before a loop is reported."""
    polling_limit: int = 20_000
    """Transitions of a loop in virtual time in which nothing happens but waiting, before it is reported."""
    progress_count: int = 0
    """How often something was written or asked for that a state's next step may depend on."""
    abandon_after_s: float = 30.0
    """How long a node may take to confirm that it stopped before the run goes on without it."""
    waits: WaitCounter = field(default_factory=WaitCounter)
    settlement: Settlement = field(default_factory=Settlement)
    pending_calls: PendingCalls = field(default_factory=PendingCalls)
    observed: ObservedAnswers = field(default_factory=ObservedAnswers)
    visits: dict[str, int] = field(default_factory=dict[str, int])
    points: dict[str, NodeCheckpoint] = field(default_factory=dict[str, NodeCheckpoint])
    """Where nodes stood that are gone on with; each is taken once."""
    world: Callable[[], Awaitable[bytes | None]] | None = None
    """Gives the state of the simulated world, to be kept with every commit."""
    is_resumed: bool = False
    """Whether the points are those of this very run, whose events tell how they were reached."""

    steps: float = 0.0
    """Steps of expressions, and of what is done for them, since everybody else on the loop last had a turn.

    Above `MAX_STEPS` they `yield_turn`.
    """
    replaced: dict[str, object] = field(default_factory=dict[str, object])
    """Nodes and containers by path, as a hot change has defined them anew; containers under `path/`."""
    branching: dict[str, BranchContainer] = field(default_factory=dict[str, "BranchContainer"])
    """The active containers whose branches a hot change may add and remove, by their paths."""
    abandoned: dict[str, asyncio.Task[Any]] = field(default_factory=dict[str, "asyncio.Task[Any]"])
    """Tasks that did not end when told to; nobody waits for them any more."""

    @property
    def needs_slow_path(self) -> bool:
        """Whether there is more to a node than running it: somebody operates, it goes on, or others are due a turn."""
        return bool(self.gate.armed or self.points or self.replaced or self.steps > MAX_STEPS)

    def counted(self) -> _Counted:
        """Count the steps of what is done inside, which never waits."""
        return _Counted(self)

    async def yield_turn(self) -> None:
        """Let everybody else on the loop have a turn, the journal's writer too; due by count, so that runs repeat.

        Raises:
            JournalError: the journal can no longer be written.
        """
        self.steps = 0.0
        await asyncio.sleep(0)
        await self.recorder.apply_backpressure()

    def abandon(self, task: asyncio.Task[Any] | None, path: str, waited_s: float) -> None:
        """Give up a task that does not end; what it leased stays leased."""
        self.recorder.emit(NodeAbandoned, path=path, waited_s=waited_s)
        if task is not None:
            self.abandoned[path] = task

    async def commit(self) -> None:
        """Make everything so far durable, the simulated world included; due before any effect.

        Raises:
            JournalError: it cannot be written; the run must stop.
        """
        if self.world is not None:
            state = await self.world()
            if state is not None:
                self.recorder.append_world_state(state)
        await self.recorder.commit()

    def point(self, path: str) -> NodeCheckpoint | None:
        """Take the point at which the node is to be gone on with, if any."""
        return self.points.pop(path, None) if self.points else None

    def latest(self, path: str, node: N) -> N:
        """Return the present definition of a node: another one after a hot change."""
        if not self.replaced:
            return node
        found = self.replaced.get(path)
        return found if isinstance(found, type(node)) else node

    def write(self, path: str, scope: Scope, key: str, value: object, *, post: str = "") -> None:
        """Write where the key lives as seen from `scope`, and record that.

        Raises:
            UserdataError: the value could not be kept as it is.
        """
        plain = plain_value(value, key=key, where=path)
        with self.counted():
            owner = scope.write(key, value)
        self.record_write(path, owner, key, plain, post=post)

    def append(self, path: str, scope: Scope, key: str, value: object) -> int:
        """Append a value, which must be nobody else's, to a list as seen from `scope`, and record that.

        Returns:
            How many values the list has now.

        Raises:
            UserdataError: the value could not be kept as it is, or `key` is no list.
        """
        plain = plain_value(value, key=key, where=path)
        with self.counted():
            owner, grown, is_new = scope.append(key, value, writer=path)
        if is_new:
            self.record_write(path, owner, key, plain_value(grown, key=key, where=path))
        else:
            self.progress_count += 1
            self.recorder.emit(UserdataAppended, path=path, scope=owner, key=key, value=plain)
        return len(grown)

    def record_write(self, path: str, scope: str, key: str, value: object, *, post: str = "") -> None:
        """Record that the node at `path`, or a post-condition of it, wrote a plain value to `key` of `scope`."""
        self.progress_count += 1
        self.recorder.emit(UserdataWritten, path=path, scope=scope, key=key, value=value, post=post)

    async def sleep(self, path: str, duration_s: float) -> None:
        """Let `duration_s` pass in which the branch of `path` is not held.

        Raises:
            StateError: it is no time that could pass.
        """
        if not duration_s <= LONGEST_S:
            raise StateError(f"this would wait for {duration_s:g} s", where=path, hint=f"{LONGEST_S:g} s are the most")
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
    """What is done inside counts; a class, since a generator costs three times as much and every read comes here."""

    __slots__ = ("_before", "_execution")

    def __init__(self, execution: Execution) -> None:
        self._execution = execution
        self._before = 0.0

    def __enter__(self) -> None:
        self._before = METER.worked

    def __exit__(self, *_: object) -> None:
        self._execution.steps += METER.worked - self._before
