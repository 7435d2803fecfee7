"""A rig with a device, a camera and a ticking topic, the states that use them, and how a run there is recorded."""

from __future__ import annotations

import asyncio
from collections.abc import AsyncGenerator, Callable, Mapping
from contextlib import asynccontextmanager
from pathlib import Path
from textwrap import dedent
from typing import Any, ClassVar, Literal

import msgspec

from engine.bus import ActiveGoal, SkillBus
from engine.clock import new_clock, run_virtual
from engine.document import Behavior, parse_behavior
from engine.errors import GoalRejected, SkillFailed
from engine.event import Event
from engine.journal import MemoryRunJournal
from engine.messages import Message
from engine.recording import RecordedDocuments, Recording, RecordingOptions, RunRecording, load_recording
from engine.replay import ReplayReport, replay
from engine.runtime.plan import new_plan
from engine.runtime.record.skill_port import BusPort, SkillPort
from engine.runtime.run import Run
from engine.runtime.run_options import RunOptions
from engine.runtime.run_result import RunResult
from engine.skill import Action, Service
from engine.state import ActivationRecord, Context, Outcome, State
from tests.engine.fake_states import CATALOGUE as PLAIN
from tests.engine.run_document import HEAD

BRAKING_S = 0.125
TICK_S = 0.25
FIRST_TICK_S = 1 / 128
"""So no tick comes together with a timer of a behavior, see `test_random_runs`."""
How = Literal["done", "fail", "reject", "crash"]


class Worked(msgspec.Struct, frozen=True):
    """What the device did."""

    worked_s: float
    stopped: bool


class Work(Action[Worked, Worked], frozen=True, kw_only=True):
    """Work for a time; come to rest in another when cancelled."""

    for_s: float
    rest_s: float = 0.0
    how: How = "done"


class Seen(msgspec.Struct, frozen=True):
    """What the camera saw."""

    number: int
    raw: bytes


class Look(Service[Seen], frozen=True, kw_only=True):
    """Look, which takes a time, or some turns of the loop and none."""

    delay_s: float = 0.0
    turns: int = 0
    how: How = "done"


class Tick(Message, frozen=True, kw_only=True):
    """How often the topic has ticked."""

    number: int


class Rig:
    """Answers at `bench` and ticks on `bench/tick`."""

    def __init__(self, bus: SkillBus) -> None:
        self._bus = bus
        self._looks = 0
        self._held = False
        bus.advertise_action(Work, self.work, namespace="bench")
        bus.advertise_service(Look, self.look, namespace="bench")

    async def work(self, goal: Work, handle: ActiveGoal[Worked]) -> Worked:
        if goal.how == "reject":
            raise GoalRejected("not today", where="bench")
        handle.accept()
        self._held = False
        handle.on_hold(self._hold)
        handle.on_resume(self._resume)
        worked_s = 0.0
        try:
            while worked_s < goal.for_s:
                step_s = min(0.125, goal.for_s - worked_s)
                await self._bus.clock.sleep(step_s)
                worked_s += 0.0 if self._held else step_s
        except asyncio.CancelledError:
            if goal.rest_s:
                await self._bus.clock.sleep(goal.rest_s)
            return Worked(worked_s, stopped=True)
        if goal.how == "fail":
            raise SkillFailed("it slipped", where="bench") from ZeroDivisionError("division by zero")
        if goal.how == "crash":
            raise ZeroDivisionError("division by zero")
        return Worked(worked_s, stopped=False)

    async def look(self, request: Look) -> Seen:
        self._looks += 1
        seen = Seen(self._looks, b"\x00\xff")
        for _ in range(request.turns):
            await asyncio.sleep(0)
        if request.delay_s:
            await self._bus.clock.sleep(request.delay_s)
        if request.how == "crash":
            raise ZeroDivisionError("division by zero")
        if request.how != "done":
            raise SkillFailed("too dark", where="bench")
        return seen

    async def tick(self) -> None:
        topic = self._bus.topic("bench/tick", Tick)
        topic.publish(Tick(number=0))
        await self._bus.clock.sleep(FIRST_TICK_S)
        number = 1
        while True:
            await self._bus.clock.sleep(TICK_S)
            topic.publish(Tick(number=number))
            number += 1

    async def _hold(self) -> None:
        await self._bus.clock.sleep(BRAKING_S)
        self._held = True

    async def _resume(self) -> None:
        self._held = False


class DoWork(State, frozen=True, kw_only=True):
    """Have the device work."""

    state_name: ClassVar[str] = "bench.Work"
    outcomes: ClassVar[tuple[str, ...]] = ("a", "b", "c")
    success: ClassVar[tuple[str, ...]] = ("a",)
    outputs: ClassVar[Mapping[str, Any]] = {"worked_s": float}
    for_s: float = 1.0
    rest_s: float = 0.0
    how: How = "done"
    to: str = "bench"

    async def run(self, ctx: Context) -> Outcome:
        end = await ctx.perform(Work(for_s=self.for_s, rest_s=self.rest_s, how=self.how), to=self.to)
        if end.result is None or end.status != "succeeded":
            return Outcome("b" if end.status == "rejected" else "c", cause=end.cause)
        return Outcome("a", {"worked_s": end.result.worked_s})

    def cannot_undo(self, done: ActivationRecord) -> str:
        return "" if self.to == "bench" else "nobody is there"

    async def undo(self, ctx: Context, done: ActivationRecord) -> None:
        await ctx.perform(Work(for_s=float(str(done.outputs.get("worked_s", 0.125)))), to=self.to)


class DoLook(State, frozen=True, kw_only=True):
    """Ask the camera."""

    state_name: ClassVar[str] = "bench.Look"
    outcomes: ClassVar[tuple[str, ...]] = ("a", "b", "c")
    success: ClassVar[tuple[str, ...]] = ("a",)
    outputs: ClassVar[Mapping[str, Any]] = {"seen": int}
    delay_s: float = 0.0
    turns: int = 0
    how: How = "done"
    times: int = 1

    async def run(self, ctx: Context) -> Outcome:
        number = 0
        for _ in range(self.times):
            seen = await ctx.call(Look(delay_s=self.delay_s, turns=self.turns, how=self.how), to="bench")
            number = seen.number
        return Outcome("a" if number % 2 else "b", {"seen": number})


class DoGlance(State, frozen=True, kw_only=True):
    """Ask the camera whether it has looked fewer times than so."""

    state_name: ClassVar[str] = "bench.Glance"
    outcomes: ClassVar[tuple[str, ...]] = ("a", "b")
    success: ClassVar[tuple[str, ...]] = ("a",)
    observes: ClassVar[bool] = True
    until: int

    async def run(self, ctx: Context) -> Outcome:
        return Outcome("a" if (await ctx.call(Look(), to="bench")).number < self.until else "b")


class Range(Message, frozen=True, kw_only=True):
    """How far away the next thing is."""

    distance_m: float


class DoSeeFar(State, frozen=True, kw_only=True):
    """Tell by the topic whether nothing is in the way; NaN is something."""

    state_name: ClassVar[str] = "bench.Far"
    outcomes: ClassVar[tuple[str, ...]] = ("a", "b")

    async def run(self, ctx: Context) -> Outcome:
        seen = await ctx.latest("range", Range)
        return Outcome("b" if seen.distance_m > 1.0 else "a")


class DoListen(State, frozen=True, kw_only=True):
    """Read the topic, the newest message or those to come."""

    state_name: ClassVar[str] = "bench.Listen"
    outcomes: ClassVar[tuple[str, ...]] = ("a", "b", "c")
    success: ClassVar[tuple[str, ...]] = ("a",)
    messages: int = 0
    topic: str = "bench/tick"

    async def run(self, ctx: Context) -> Outcome:
        tick = await ctx.latest(self.topic, Tick)
        for _ in range(self.messages):
            tick = await ctx.next_message(self.topic, Tick)
        ctx.log(f"tick {tick.number}, {ctx.random():.3f}")
        return Outcome("abc"[tick.number % 3])


CATALOGUE: dict[str, type[State]] = {
    **PLAIN,
    **{state.state_name: state for state in (DoWork, DoLook, DoGlance, DoSeeFar, DoListen)},
}

Act = Callable[[Run], object]


def behavior_of(text: str, *, file: str = "test.yaml") -> Behavior:
    """Read a behavior; text without `flexcell` gets a head with outcomes good and bad."""
    body = dedent(text)
    return parse_behavior(body if "flexcell" in body else HEAD + body, file=file)


@asynccontextmanager
async def open_rig() -> AsyncGenerator[SkillBus]:
    """Open a bus with the rig on it."""
    async with SkillBus(new_clock()) as bus:
        rig = Rig(bus)
        ticking = asyncio.create_task(rig.tick(), name="ticking")
        try:
            yield bus
        finally:
            ticking.cancel()
            await asyncio.wait({ticking})


async def record_run(
    text: str,
    path: Path,
    *,
    acts: Mapping[float, Act] | None = None,
    rate_hz: float = 0.0,
    topics: tuple[str, ...] = ("*",),
    parameters: Mapping[str, object] | None = None,
    inputs: Mapping[str, object] | None = None,
    seed: int = 0,
    supervision: RunOptions | None = None,
    prepare: Callable[[SkillBus], object] = lambda bus: None,
    skills: Callable[[SkillBus], SkillPort] = BusPort,
) -> tuple[RunResult, tuple[Event, ...]]:
    """Run a document at the bench and record it; at each time do what `acts` says with the run."""
    behavior = behavior_of(text)
    texts = {"test.yaml": msgspec.json.encode(behavior.document)}
    events: list[Event] = []
    order = RecordingOptions(
        path=path, documents=RecordedDocuments(behavior="test.yaml", texts=texts), rate_hz=rate_hz, topics=topics
    )
    loop = asyncio.get_running_loop()
    async with open_rig() as bus, RunRecording.open(order, inline=bus.clock.virtual) as recording:
        prepare(bus)
        run = Run(
            new_plan(behavior, CATALOGUE),
            run="r",
            bus=bus,
            parameters=parameters,
            inputs=inputs,
            seed=seed,
            supervision=supervision,
            skills=skills(bus),
            journal=MemoryRunJournal(run_id="r"),
        )
        recording.attach(run, bus, started_unix_s=1.0, inputs=inputs, supervision=supervision)
        run.watch(events.append)
        timers = [loop.call_later(at_s, act, run) for at_s, act in (acts or {}).items()]
        result = await run.execute()
        for timer in timers:
            timer.cancel()
    return result, tuple(events)


def recorded(text: str, path: Path, **options: Any) -> Recording:
    """Record a document in virtual time and load the recording."""
    run_virtual(record_run(text, path, **options))
    return load_recording(path)


def replayed(text: str, path: Path, **options: Any) -> ReplayReport:
    """Record a document in virtual time and replay it."""
    return replay(recorded(text, path, **options), CATALOGUE)
