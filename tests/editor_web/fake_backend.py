"""A backend without robots: plays believable runs of a few behaviors, for tests and for work on the page."""

from __future__ import annotations

import asyncio
import time
from collections.abc import AsyncGenerator, Callable, Iterable, Mapping
from contextlib import suppress
from functools import cache
from pathlib import Path
from types import SimpleNamespace
from typing import Any, cast

from msgspec.structs import replace

from engine.archive import Archive
from engine.bus import GoalHandle, SkillBus
from engine.bus.bus import BusEntry
from engine.bus.json_bus import JsonBus
from engine.cell import CellConnection, OpenCell
from engine.clock import LoopClock
from engine.document.cell import Cell, load_cell
from engine.document.faults import Faults
from engine.editing import DocumentRepository
from engine.errors import BusError, ControlError, FlexcellError
from engine.event import (
    Event,
    GoalFinished,
    GoalSent,
    MessageLogged,
    NodeEntered,
    NodeExited,
    RunEnded,
    RunStarted,
    StopRequested,
    TransitionTaken,
)
from engine.library.behavior_graph import GraphNode
from engine.library.behavior_library import BehaviorView
from engine.project.bus_inspector import BusInspector
from engine.project.cell_reopening import CellReopening
from engine.project.cell_stop import CellStop
from engine.project.run_request import RunPosition
from engine.project.session import RunCallback, Session
from engine.project.session_operators import RunOperator
from engine.project.session_run import InterruptedRun
from engine.project.stop_recovery import StopRecovery
from engine.runtime.control import Breakpoint, Control
from engine.runtime.history.hot_change import ChangeReport
from engine.runtime.history.live_run import LiveRun
from engine.runtime.history.run_view import RunView
from engine.runtime.history.userdata_history import UserdataHistory
from engine.runtime.run_options import RunOptions
from engine.skills.goal_end import GoalEnd
from tests.editor_web.fake_behaviors import BROKEN, NOTHING_HELD, SINGLE, TRANSFER
from tests.editor_web.fake_scene import frames_at, new_scene


class TopicBus:
    """A bus with topics and nobody who answers."""

    def __init__(self, topics: Mapping[str, object]) -> None:
        self._topics = topics

    async def listing(self) -> tuple[BusEntry, ...]:
        return tuple(
            BusEntry(kind="topic", name=name, type=type(message).__name__, detail="")
            for name, message in self._topics.items()
        )

    async def echo(self, topic: str) -> AsyncGenerator[str, None]:
        raise BusError("no such topic", where=topic)
        yield ""

    async def publish(self, topic: str, message: object) -> None:
        raise BusError("no such topic", where=topic)

    async def call(self, address: str, request: object) -> str:
        raise BusError("no such service", where=address)

    async def perform(
        self, address: str, goal: object, *, on_sent: Callable[[GoalHandle[Any, Any]], None] | None = None
    ) -> GoalEnd[Any]:
        raise BusError("no such service", where=address)


@cache
def _cell() -> Cell:
    """Return the document of the cell that is played."""
    return load_cell(Path(__file__).parents[2] / "behaviors" / "cells" / "dual_panda.yaml")


class NoRecovery(StopRecovery):
    """The recovery of a cell that nobody stops."""

    def __init__(self) -> None:
        pass

    def when_changed(self, callback: Callable[[], None]) -> Callable[[], None]:
        return lambda: None

    @property
    def is_stopped(self) -> bool:
        return False

    async def state(self) -> CellStop | None:
        return None


class FakeBackend(Session):
    """A session without an engine; leaves take `step_s`, `single_pick` fails at its grasp.

    Nothing of the base class is constructed; what a page asks for is overridden here.
    """

    def __init__(
        self,
        *,
        step_s: float = 0.2,
        behaviors: tuple[BehaviorView, ...] = (BROKEN, SINGLE, TRANSFER),
        documents: DocumentRepository | None = None,
    ) -> None:
        self.lost_reason = ""
        self.recovery = NoRecovery()
        self.reopening = CellReopening(None)
        self.cell = cast("OpenCell", SimpleNamespace(document=_cell()))
        self.archive = Archive(Path("no-project"), {}, Path("no-journal"))
        self.documents = documents or DocumentRepository(Path("no-project"), {})
        self.kept_breakpoints: dict[str, tuple[Breakpoint, ...]] = {}
        self.step_s = step_s
        self._ended = asyncio.Event()
        self.recorded: dict[str, tuple[Path, ...]] = {}
        self._behaviors = {b.id: b for b in behaviors}
        self._played: dict[str, RunView] = {}
        self._lives: dict[str, LiveRun] = {}
        self._began_s: dict[str, float] = {}
        self._visits: dict[tuple[str, str], int] = {}
        self._tasks: dict[str, asyncio.Task[None]] = {}
        self._watchers: list[RunCallback] = []
        self._topics: dict[str, object] = {"cell/scene": new_scene(), "cell/frames": frames_at(0.0)}
        self.known_bus: JsonBus = TopicBus(self._topics)
        self.known_inspector: BusInspector | None = None
        self._topic_callbacks: dict[str, list[Callable[[object], None]]] = {}
        self.listeners_changed = asyncio.Event()

    @property
    def cell_name(self) -> str:
        return "dual_panda"

    @property
    def bus(self) -> JsonBus:
        return self.known_bus

    @property
    def inspector(self) -> BusInspector:
        if self.known_inspector is None:
            self.known_inspector = BusInspector(SkillBus(LoopClock()))
        return self.known_inspector

    def behaviors(self) -> tuple[BehaviorView, ...]:
        return tuple(sorted(self._behaviors.values(), key=lambda b: b.id))

    def behavior(self, behavior_id: str) -> BehaviorView:
        if behavior_id not in self._behaviors:
            raise FlexcellError(f"no behavior {behavior_id!r}")
        return self._behaviors[behavior_id]

    def runs(self) -> tuple[RunView, ...]:
        return tuple(map(_now, reversed(self._played.values())))

    def run(self, run_id: str) -> RunView:
        if run_id not in self._played:
            raise FlexcellError(f"no run {run_id!r}")
        return _now(self._played[run_id])

    async def start(
        self,
        behavior_id: str,
        *,
        parameters: Mapping[str, object],
        seed: int,
        inputs: Mapping[str, object] | None = None,
        supervision: RunOptions | None = None,
        breakpoints: bool = False,
        begin: RunPosition | None = None,
        until: str | None = None,
        faults: Faults | None = None,
    ) -> str:
        behavior = self.behavior(behavior_id)
        if behavior.graph is None:
            raise FlexcellError("the document has errors", where=behavior_id, hint="see its problems")
        if any(not task.done() for task in self._tasks.values()):
            raise FlexcellError("the cell is busy with another run", hint="stop it first")
        self._check(behavior, parameters)
        run_id = f"run-{len(self._played) + 1:03d}"
        self._played[run_id] = _begun(run_id, behavior_id)
        self._lives[run_id] = LiveRun(run_id)
        self._began_s[run_id] = time.monotonic()
        self._tasks[run_id] = asyncio.create_task(self._play(run_id, behavior, dict(parameters), seed), name=run_id)
        return run_id

    async def stop(self, run_id: str, *, reason: str) -> None:
        run = self.run(run_id)
        if run.status != "running":
            return
        self._played[run_id] = replace(run, status="stopping")
        self._emit(run_id, StopRequested, reason=reason)
        self._tasks[run_id].cancel()

    def subscribe(self, callback: RunCallback) -> Callable[[], None]:
        self._watchers.append(callback)
        return lambda: self._watchers.remove(callback)

    def events(self, run_id: str, *, after: int = 0) -> list[Event]:
        return [e for e in self.live(run_id).events if e.seq > after]

    def live(self, run_id: str) -> LiveRun:
        self.run(run_id)
        return self._lives[run_id]

    def userdata(self, run_id: str) -> UserdataHistory:
        raise FlexcellError("this fake keeps no userdata", where=run_id)

    def recording_files(self, run_id: str) -> tuple[Path, ...]:
        return self.recorded.get(run_id, ())

    def latest(self, topic: str) -> object | None:
        return self._topics.get(topic)

    def subscribe_topic(self, topic: str, callback: Callable[[object], None]) -> Callable[[], None]:
        callbacks = self._topic_callbacks.setdefault(topic, [])
        callbacks.append(callback)
        self.listeners_changed.set()
        if topic in self._topics:
            callback(self._topics[topic])
        return lambda: self._forget(callbacks, callback)

    def control(self, run_id: str) -> Control:
        raise ControlError("this fake has no control", where=run_id)

    def operate(self, run_id: str) -> RunOperator:
        raise ControlError("this fake has no control", where=run_id)

    async def change(self, run_id: str, *, preempt: bool = False) -> ChangeReport:
        raise ControlError("this fake has no control", where=run_id)

    async def step_back(self, run_id: str, path: str = "") -> tuple[str, ...]:
        raise ControlError("this fake has no control", where=run_id)

    def breakpoints(self, behavior_id: str) -> tuple[Breakpoint, ...]:
        self.behavior(behavior_id)
        return self.kept_breakpoints.get(behavior_id, ())

    def keep_breakpoints(self, behavior_id: str, breakpoints: Iterable[Breakpoint]) -> None:
        self.behavior(behavior_id)
        self.kept_breakpoints[behavior_id] = tuple(breakpoints)

    async def stop_all(self, *, reason: str) -> None:
        for run_id in self._played:
            await self.stop(run_id, reason=reason)

    @property
    def cell_connection(self) -> CellConnection:
        return CellConnection(connected=not self.lost_reason, reason=self.lost_reason)

    async def connect_cell(self) -> None:
        if any(not task.done() for task in self._tasks.values()):
            raise ControlError("a run is active", hint="stop it first, then connect the cell")
        self.lost_reason = ""

    def interrupted(self) -> tuple[InterruptedRun, ...]:
        return ()

    async def resume(self, run_id: str, *, answers: Mapping[str, str] | None = None, changed: bool = False) -> str:
        raise ControlError("this fake resumes nothing", where=run_id)

    def publish(self, topic: str, message: object) -> None:
        """Publish on a topic."""
        self._topics[topic] = message
        for callback in list(self._topic_callbacks.get(topic, [])):
            callback(message)

    def _forget(self, callbacks: list[Callable[[object], None]], callback: Callable[[object], None]) -> None:
        callbacks.remove(callback)
        self.listeners_changed.set()

    async def end_step(self) -> None:
        """End every leaf that is active now, before its time."""
        ended, self._ended = self._ended, asyncio.Event()
        ended.set()

    def listeners(self, topic: str) -> int:
        """How many are called back with the messages of a topic."""
        return len(self._topic_callbacks.get(topic, ()))

    def emit(self, run_id: str, kind: type[Event], /, **fields: object) -> None:
        """Append one event to a run from outside."""
        self._played.setdefault(run_id, _begun(run_id, TRANSFER.id))
        self._lives.setdefault(run_id, LiveRun(run_id))
        self._began_s.setdefault(run_id, time.monotonic())
        self._emit(run_id, kind, **fields)

    def file(self, run_id: str, outcome: str) -> None:
        """Take a run that was emitted from outside as finished."""
        self._played[run_id] = replace(
            self._played[run_id], status="finished", outcome=outcome, success=True, ticking=False
        )

    def subscribers(self) -> tuple[RunCallback, ...]:
        """Who is told of events."""
        return tuple(self._watchers)

    async def close(self) -> None:
        """Stop what still runs."""
        for task in self._tasks.values():
            task.cancel()
        await asyncio.gather(*self._tasks.values(), return_exceptions=True)

    @staticmethod
    def _check(behavior: BehaviorView, parameters: Mapping[str, object]) -> None:
        for parameter in behavior.parameters:
            value = parameters.get(parameter.name)
            if parameter.required and value in (None, ""):
                raise FlexcellError("a value is required", where=parameter.name, hint="name a stored entry")
            if value == "ghost":
                raise FlexcellError("no entry is named 'ghost'", where=parameter.name, hint="see the store")
            highest = parameter.schema.get("maximum")
            if isinstance(value, float | int) and isinstance(highest, float | int) and value > highest:
                raise FlexcellError(f"{value} is above the maximum {highest}", where=parameter.name)

    def _emit(self, run_id: str, kind: type[Event], /, **fields: object) -> None:
        live = self._lives[run_id]
        event = kind(seq=len(live.events) + 1, time_s=time.monotonic() - self._began_s[run_id], **fields)
        change = live.apply(event)
        assert change is not None
        for callback in list(self._watchers):
            callback(live, change)

    async def _play(self, run_id: str, behavior: BehaviorView, parameters: dict[str, object], seed: int) -> None:
        assert behavior.graph is not None
        self._emit(
            run_id,
            RunStarted,
            behavior=behavior.name,
            document="sha256:0",
            parameters=parameters,
            seed=seed,
            clock="real",
        )
        motion = asyncio.create_task(self._move_arms(), name="arms")
        try:
            outcome = await self._node(run_id, behavior.graph)
            status = "finished"
        except asyncio.CancelledError:
            outcome, status = None, "stopped"
        finally:
            motion.cancel()
        cause = NOTHING_HELD if outcome == "failed" else None
        run = self._played[run_id]
        self._played[run_id] = replace(
            run,
            status=status,
            outcome=outcome,
            success=outcome == "finished",
            cause=cause.message if cause else "",
            duration_s=time.time() - run.started_at_s,
            ticking=False,
        )
        self._emit(run_id, RunEnded, status=status, outcome=outcome, cause=cause)

    async def _node(self, run_id: str, node: GraphNode) -> str:
        visit = self._visits[run_id, node.path] = self._visits.get((run_id, node.path), 0) + 1
        self._emit(run_id, NodeEntered, path=node.path, visit=visit, kind=node.kind, inputs={})
        try:
            match node.kind:
                case "machine":
                    outcome = await self._machine(run_id, node)
                case "concurrency":
                    await asyncio.gather(*(self._node(run_id, child) for child in node.children))
                    outcome = node.outcomes[0]
                case _:
                    outcome = await self._leaf(run_id, node)
        except asyncio.CancelledError:
            self._emit(run_id, NodeExited, path=node.path, visit=visit, outcome="preempted", preempted=True)
            raise
        cause = NOTHING_HELD if outcome == "failed" else None
        self._emit(run_id, NodeExited, path=node.path, visit=visit, outcome=outcome, cause=cause)
        return outcome

    async def _machine(self, run_id: str, node: GraphNode) -> str:
        children = {child.name: child for child in node.children}
        name = node.initial or node.children[0].name
        while name in children:
            outcome = await self._node(run_id, children[name])
            arrow = next(t for t in node.transitions if (t.source, t.outcome) == (name, outcome))
            self._emit(run_id, TransitionTaken, path=node.path, source=name, outcome=outcome, target=arrow.target)
            name = arrow.target
        return name

    async def _leaf(self, run_id: str, node: GraphNode) -> str:
        side = "right" if "right" in node.path else "left"
        goal = f"{run_id}:{node.path}"
        self._emit(
            run_id,
            GoalSent,
            path=node.path,
            goal=goal,
            address=f"{side}/{node.title.rsplit('.', 1)[-1]}",
            request={"speed": 0.5},
        )
        ended = self._ended
        with suppress(TimeoutError):
            await asyncio.wait_for(ended.wait(), self.step_s * (1.25 if side == "right" else 1.0))
        fails = node.path == "root/grasp"
        status = "aborted" if fails else "succeeded"
        self._emit(run_id, GoalFinished, path=node.path, goal=goal, status=status)
        if node.name in ("grasp", "home"):
            self._emit(run_id, MessageLogged, path=node.path, level="info", message="width 30.1 mm, force 19.8 N")
        return "failed" if fails else node.outcomes[0]

    async def _move_arms(self) -> None:
        began_s = time.monotonic()
        while True:
            self.publish("cell/frames", frames_at(time.monotonic() - began_s))
            await asyncio.sleep(1 / 30)


def _begun(run_id: str, behavior_id: str) -> RunView:
    return RunView(
        id=run_id,
        behavior=behavior_id,
        status="running",
        outcome=None,
        success=False,
        cause="",
        started_at_s=time.time(),
        duration_s=0.0,
        ticking=True,
    )


def _now(run: RunView) -> RunView:
    return replace(run, duration_s=time.time() - run.started_at_s) if run.ticking else run
