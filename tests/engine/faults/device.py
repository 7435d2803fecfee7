"""A gripper on a bus, states that use it, and runs of them with faults, all in virtual time."""

from __future__ import annotations

import asyncio
from dataclasses import dataclass, field
from textwrap import dedent
from typing import ClassVar

from engine.bus import ActiveGoal, SkillBus
from engine.clock import new_clock, run_virtual
from engine.document import parse_behavior
from engine.errors import SkillFailed
from engine.event import Event, FaultInjected, GoalFinished, MessageLogged
from engine.faults import FaultPort, parse_faults
from engine.messages import GripperState
from engine.runtime.plan import new_plan
from engine.runtime.record.skill_port import BusPort
from engine.runtime.run import Run
from engine.runtime.run_options import RunOptions
from engine.runtime.run_result import RunResult
from engine.skills.gripper import GraspResult, GripperFeedback, GripperGrasp, ReadGripper
from engine.state import Context, Outcome, State
from tests.engine.fake_states import CATALOGUE

HEAD = "flexcell: 1\nname: test\noutcomes: [good, bad]\nsuccess: [good]\n"
GRASP_S = 2.0


class Gripper:
    """Takes two seconds for a grasp; writes down what reaches it and what it does."""

    def __init__(self, *, breaks_at_read: int | None = None) -> None:
        self.log: list[str] = []
        self.held = False
        self._breaks_at_read = breaks_at_read

    async def grasp(self, goal: GripperGrasp, handle: ActiveGoal[GripperFeedback]) -> GraspResult:
        handle.accept()
        stopped = asyncio.Event()
        handle.on_cancel(stopped.set)
        handle.on_hold(self._hold)
        handle.on_resume(self._resume)
        self.log.append(f"grasp {handle.id}")
        try:
            async with asyncio.timeout(GRASP_S):
                await stopped.wait()
            self.log.append("stopped")
        except TimeoutError:
            self.log.append("grasped")
            self.held = True
        return GraspResult(held=self.held, width_m=goal.width_m, force_n=20.0)

    def read(self, request: ReadGripper) -> GripperState:
        self.log.append("read")
        if self.log.count("read") == self._breaks_at_read:
            raise SkillFailed("it takes one request only", where="left/gripper")
        return self.state(0.01 * self.log.count("read"))

    def state(self, width_m: float) -> GripperState:
        return GripperState(time_s=0.0, width_m=width_m, force_n=0.0, held=self.held)

    async def _hold(self) -> None:
        self.log.append("held")

    async def _resume(self) -> None:
        self.log.append("resumed")


class Grasp(State, frozen=True, kw_only=True):
    """Grasp and say how the goal ended."""

    state_name: ClassVar[str] = "gripper.Grasp"
    outcomes: ClassVar[tuple[str, ...]] = ("succeeded", "aborted", "rejected", "canceled")
    success: ClassVar[tuple[str, ...]] = ("succeeded",)

    async def run(self, ctx: Context) -> Outcome:
        end = await ctx.perform(GripperGrasp(width_m=0.03), to="left/gripper")
        return Outcome(end.status, cause=end.cause)


class Read(State, frozen=True, kw_only=True):
    """Ask for the width, some times, and log it."""

    state_name: ClassVar[str] = "gripper.Read"
    outcomes: ClassVar[tuple[str, ...]] = ("read", "failed")
    times: int = 1

    async def run(self, ctx: Context) -> Outcome:
        for _ in range(self.times):
            try:
                state = await ctx.call(ReadGripper(), to="left/gripper")
            except SkillFailed as error:
                ctx.log(f"failed: {error.message}")
                return Outcome("failed")
            ctx.log(f"{state.width_m:g}")
        return Outcome("read")


class Listen(State, frozen=True, kw_only=True):
    """Log the next messages of the gripper's topic."""

    state_name: ClassVar[str] = "gripper.Listen"
    outcomes: ClassVar[tuple[str, ...]] = ("heard",)
    times: int = 2

    async def run(self, ctx: Context) -> Outcome:
        for _ in range(self.times):
            ctx.log(f"{(await ctx.next_message('left/gripper/state', GripperState)).width_m:g}")
        return Outcome("heard")


STATES: dict[str, type[State]] = {**CATALOGUE, **{s.state_name: s for s in (Grasp, Read, Listen)}}


@dataclass(frozen=True)
class ObservedRun:
    """What came of a run: its result, its events, and what the gripper and the killer saw."""

    result: RunResult
    events: tuple[Event, ...]
    device: tuple[str, ...]
    killed_at: tuple[int, ...]

    @property
    def faults(self) -> list[tuple[float, str, str, str]]:
        """When, where and what of each fault that was applied."""
        return [(e.time_s, e.path, e.fault, e.detail) for e in self.events if isinstance(e, FaultInjected)]

    @property
    def ends(self) -> list[tuple[float, str]]:
        """When and how goals ended for their states."""
        return [(e.time_s, e.status) for e in self.events if isinstance(e, GoalFinished)]

    @property
    def logged(self) -> list[tuple[float, str]]:
        """What states and faults said."""
        return [(e.time_s, e.message) for e in self.events if isinstance(e, MessageLogged)]


@dataclass
class Killer:
    """Stands in for the end of the process: notes after which event it was asked for."""

    events: list[Event]
    seen: list[int] = field(default_factory=list[int])

    def __call__(self) -> None:
        self.seen.append(len(self.events))


def run_with_faults(
    behavior: str,
    faults: str,
    *,
    seed: int = 0,
    stop_at_s: float | None = None,
    pause_s: tuple[float, float] | None = None,
    messages: int = 0,
    breaks_at_read: int | None = None,
) -> ObservedRun:
    """Run `root:` of a behavior with `faults:` in virtual time; the topic gets a message a second."""
    plan = new_plan(parse_behavior(HEAD + dedent(behavior), file="test.yaml"), STATES)
    events: list[Event] = []
    killer = Killer(events)
    log: list[str] = []

    async def main() -> RunResult:
        bus = SkillBus(new_clock())
        gripper = Gripper(breaks_at_read=breaks_at_read)
        gripper.log = log
        bus.advertise_action(GripperGrasp, gripper.grasp, namespace="left/gripper")
        bus.advertise_service(ReadGripper, gripper.read, namespace="left/gripper")
        document = parse_faults("flexcell: 1\nfaults:\n" + dedent(faults), file="faults.yaml")
        port = FaultPort(BusPort(bus), document, clock=bus.clock, seed=seed, kill=killer)
        run = Run(plan, run="r", bus=bus, seed=seed, skills=port, supervision=RunOptions(abandon_after_s=30.0))
        run.watch(events.append)
        loop = asyncio.get_running_loop()
        if stop_at_s is not None:
            loop.call_later(stop_at_s, run.stop, "test")
        if pause_s is not None:
            loop.call_later(pause_s[0], run.control.pause)
            loop.call_later(pause_s[1], run.control.resume)
        topic = bus.topic("left/gripper/state", GripperState)
        for second in range(1, messages + 1):
            loop.call_later(second, topic.publish, gripper.state(float(second)))
        return await run.execute()

    return ObservedRun(run_virtual(main()), tuple(events), tuple(log), tuple(killer.seen))
