"""Two runs of one behavior on two arms of one cell at a time; who wants an arm that is taken is told by whom."""

from __future__ import annotations

import asyncio
import re
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

import pytest

from engine.cell.open_cell import OpenCell
from engine.clock import run_virtual
from engine.document import load_cell, parse_behavior
from engine.event import Event, GoalSent, NodeEntered, NodeExited, RunEnded, RunStarted
from engine.journal import Journal, encode_event_log, list_runs, read_events
from engine.project.session import Session
from engine.registry import load_states
from engine.runtime.plan import Plan, new_plan
from engine.runtime.run import Run
from engine.runtime.run_result import RunResult

BEHAVIORS = Path(__file__).parents[3] / "behaviors"
WAVE = """
flexcell: 1
name: wave
parameters: {robot: {type: string, choices: [left, right]}}
outcomes: [finished, failed]
success: [finished]
root:
  machine:
    initial: away
    states:
      away:
        state: motion.MoveJoints
        with: {robot: "${robot}", target: {entry: "${robot}_carry"}}
        transitions: {reached: back, failed: failed}
      back:
        state: motion.MoveJoints
        with: {robot: "${robot}", target: {entry: "${robot}_home"}}
        transitions: {reached: finished, failed: failed}
"""
THIRD_AT_S = 0.3
"""The first state of the others takes longer than this."""


@dataclass
class _Arms:
    """What three runs on two arms came to."""

    results: Mapping[str, RunResult]
    events: Mapping[str, tuple[Event, ...]]


def _wave() -> Plan:
    return new_plan(parse_behavior(WAVE, file="wave.yaml"), load_states())


async def _three_runs(store: Path) -> _Arms:
    """Start one run on each arm, and a third on the left arm while the others are under way."""
    plan = _wave()
    events: dict[str, list[Event]] = {"on_left": [], "on_right": [], "third": []}
    async with OpenCell(load_cell(BEHAVIORS / "cells" / "dual_panda.yaml"), store_path=str(store)) as cell:
        runs = {
            name: Run(plan, run=name, bus=cell.bus, parameters={"robot": robot})
            for name, robot in (("on_left", "left"), ("on_right", "right"), ("third", "left"))
        }
        for name, run in runs.items():
            run.watch(events[name].append)
        first = [asyncio.create_task(runs[name].execute()) for name in ("on_left", "on_right")]
        await cell.bus.clock.sleep(THIRD_AT_S)
        third = await runs["third"].execute()
        left, right = await asyncio.gather(*first)
        results = {"on_left": left, "on_right": right, "third": third}
    return _Arms(results, {name: tuple(log) for name, log in events.items()})


@pytest.fixture(scope="module")
def arms(tmp_path_factory: pytest.TempPathFactory) -> _Arms:
    """The three runs, in lockstep with physics."""
    return run_virtual(_three_runs(tmp_path_factory.mktemp("two_runs") / "store.db"))


def test_both_arms_move_at_once_and_both_runs_succeed(arms: _Arms) -> None:
    """The runs overlap: each began before the other had left its first state."""
    assert {name: arms.results[name].outcome for name in ("on_left", "on_right")} == dict.fromkeys(
        ("on_left", "on_right"), "finished"
    )
    first_exit_s = [_times(arms.events[name], NodeExited)[0] for name in ("on_left", "on_right")]
    assert min(first_exit_s) > THIRD_AT_S


@pytest.mark.parametrize(("run", "robot"), [("on_left", "left"), ("on_right", "right")])
def test_the_events_of_two_runs_are_not_mixed(arms: _Arms, run: str, robot: str) -> None:
    """Each log is numbered without gaps, begins and ends once, and knows one arm only."""
    log = arms.events[run]
    assert [event.seq for event in log] == list(range(1, len(log) + 1))
    assert [type(event) for event in log if isinstance(event, RunStarted | RunEnded)] == [RunStarted, RunEnded]
    assert {event.address for event in log if isinstance(event, GoalSent)} == {f"{robot}/joint_trap_vel"}
    assert [event.path for event in log if isinstance(event, NodeEntered)] == ["root", "root/away", "root/back"]


def test_the_third_run_is_refused_the_arm_and_learns_run_and_state_of_the_holder(arms: _Arms) -> None:
    """At once, before anything is asked of the arm."""
    third = arms.results["third"]
    assert third.status == "errored"
    assert third.cause is not None
    root_cause = third.cause.chain()[-1]
    assert (root_cause.kind, root_cause.where) == ("LeaseRefused", "run third at root/away")
    assert root_cause.message == (
        "left is commanded by run on_left at root/away (wait for run on_left to end or stop it)"
    )
    assert third.duration_s == 0.0
    assert [event for event in arms.events["third"] if isinstance(event, GoalSent)] == []


def test_an_arm_is_free_again_when_its_run_has_ended(tmp_path: Path) -> None:
    """Another run may have it at once; the two do not differ in what they did."""

    async def twice() -> list[list[Event]]:
        plan = _wave()
        logs: list[list[Event]] = []
        async with OpenCell(
            load_cell(BEHAVIORS / "cells" / "dual_panda.yaml"), store_path=str(tmp_path / "store.db")
        ) as cell:
            for name in ("one", "two"):
                run = Run(plan, run=name, bus=cell.bus, parameters={"robot": "right"})
                logs.append([])
                run.watch(logs[-1].append)
                assert (await run.execute()).success
        return logs

    one, two = run_virtual(twice())
    assert [type(event) for event in one] == [type(event) for event in two]


@pytest.fixture
def project(tmp_path: Path) -> Path:
    """A project with the one behavior."""
    folder = tmp_path / "behaviors"
    folder.mkdir()
    (folder / "wave.yaml").write_text(WAVE, encoding="utf-8")
    return tmp_path


@pytest.mark.virtual
async def test_a_session_keeps_two_runs_of_one_behavior_apart(project: Path) -> None:
    """Started, told, journaled and refused by run id."""
    told: dict[str, list[Event]] = {}
    cell_document = load_cell(BEHAVIORS / "cells" / "dual_panda.yaml")
    with Journal.open(project / "journal", inline=True) as journal:
        async with (
            OpenCell(cell_document, store_path=str(project / "store.db")) as cell,
            Session(cell, project=project, catalogue=load_states(), journal=journal) as session,
        ):
            session.subscribe(lambda run, _change: told.setdefault(run.run_id, []).append(run.events[-1]))
            left = await _start(session, "left")
            right = await _start(session, "right")
            await cell.bus.clock.sleep(THIRD_AT_S)
            third = await session.wait(await _start(session, "left"))
            assert {view.id: view.status for view in session.runs()} == {
                left: "running",
                right: "running",
                third.id: "errored",
            }
            ends = [await session.wait(run) for run in (left, right)]
    assert [(view.status, view.outcome, view.success) for view in ends] == [("finished", "finished", True)] * 2
    assert re.search(f"left is commanded by run {re.escape(left)} at root/away", third.cause), third.cause
    for run, robot in ((left, "left"), (right, "right")):
        assert {event.address for event in told[run] if isinstance(event, GoalSent)} == {f"{robot}/joint_trap_vel"}
        assert encode_event_log(read_events(project / "journal", run)) == encode_event_log(told[run])
    assert {record.id: record.status for record in list_runs(project / "journal")} == {
        left: "finished",
        right: "finished",
        third.id: "errored",
    }


async def _start(session: Session, robot: str) -> str:
    return await session.start("behaviors/wave.yaml", parameters={"robot": robot}, seed=0)


def _times(log: tuple[Event, ...], kind: type[Event]) -> list[float]:
    return [event.time_s for event in log if isinstance(event, kind)]
