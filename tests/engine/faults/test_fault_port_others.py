"""Faults stand around any port: one that answers from a script, another set of faults."""

from __future__ import annotations

from typing import Any, TypeVar

import msgspec
import pytest

from engine.bus import GoalEnd, GoalStatus, Holder
from engine.clock import new_clock
from engine.errors import SkillFailed
from engine.event import Event, FaultInjected
from engine.faults import FaultPort, parse_faults
from engine.journal import NullRunJournal
from engine.messages import GripperState
from engine.runtime.record.recorder import Recorder
from engine.runtime.record.skill_port import Goal
from engine.skill import Action, Service
from engine.skills.gripper import GraspResult, GripperGrasp, ReadGripper

R = TypeVar("R")
F = TypeVar("F")
S = TypeVar("S", bound=msgspec.Struct)
HELD = GraspResult(held=True, width_m=0.03, force_n=20.0)
STATE = GripperState(time_s=0.0, width_m=0.03, force_n=0.0, held=True)
ME = Holder("r", "root/grasp")


class Done:
    """A goal that has been done before anybody asks."""

    finished = True

    async def result(self) -> GoalEnd[Any]:
        return GoalEnd(GoalStatus.SUCCEEDED, HELD, None)

    def cancel(self) -> None:
        """Come too late."""

    async def hold(self) -> None:
        """Be at rest already."""

    async def resume(self) -> None:
        """Stay at rest."""


class Script:
    """Answers everything at once with what stands above, and counts."""

    def __init__(self) -> None:
        self.asked = 0

    async def call(self, request: Service[R], *, to: str, holder: Holder) -> R:
        self.asked += 1
        answer: Any = STATE
        return answer

    def send_goal(self, goal: Action[R, F], *, to: str, holder: Holder, goal_id: str) -> Goal:
        self.asked += 1
        return Done()

    async def latest(self, topic: str, kind: type[S], *, holder: Holder) -> S:
        return await self.next_message(topic, kind, holder=holder)

    async def next_message(self, topic: str, kind: type[S], *, holder: Holder) -> S:
        self.asked += 1
        answer: Any = STATE
        return answer


def _around(inner: Any, faults: str) -> FaultPort:
    return FaultPort(inner, parse_faults(f"flexcell: 1\nfaults: [{faults}]\n", file="f.yaml"), clock=new_clock())


@pytest.mark.virtual
async def test_a_port_that_is_no_bus_goes_wrong_as_well() -> None:
    """Without a run too: then nothing is recorded."""
    script = Script()
    port = _around(script, "{address: left/read_gripper, error: no answer}, {late: 3 s}")
    with pytest.raises(SkillFailed, match="no answer"):
        await port.call(ReadGripper(), to="left", holder=ME)
    clock = new_clock()
    end = await port.send_goal(GripperGrasp(width_m=0.03), to="left", holder=ME, goal_id="g1").result()
    assert (end.result, clock.now_s(), script.asked, port.unapplied()) == (HELD, 3.0, 1, ())


@pytest.mark.virtual
async def test_faults_around_faults_are_reported_in_one_log() -> None:
    """The inner ones see the copy that the outer ones make."""
    inner = _around(Script(), "{request: 2, error: once only}")
    outer = _around(inner, "{duplicate: at_once}")
    events: list[Event] = []
    recorder = Recorder(new_clock(), NullRunJournal(run_id="r"))
    recorder.watch(events.append)
    outer.begin(recorder)
    assert await outer.call(ReadGripper(), to="left", holder=ME) == STATE
    outer.end()
    assert [event.detail for event in events if isinstance(event, FaultInjected)] == [
        "asked twice",
        "fails: once only",
        "the copy of the request failed: left/read_gripper: once only",
    ]
