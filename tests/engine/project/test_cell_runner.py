"""Starting runs: what is refused leaves no trace, and a journal knows all that is needed to go on."""

from __future__ import annotations

import os
from dataclasses import replace
from pathlib import Path

import pytest

from engine.cell.open_cell import OpenCell
from engine.clock import run_virtual
from engine.document import load_behavior, load_cell
from engine.errors import ControlError, DocumentError, JournalError
from engine.journal import Journal, NullJournal, list_runs, read_origin
from engine.project.cell_runner import CellRunner
from engine.project.resume_plan import plan_resume
from engine.project.run_request import RunRequest, require_names
from engine.recording.recorded_run import read_run
from engine.registry import load_states
from engine.runtime.plan import Plan, new_plan
from engine.runtime.run_options import RunOptions
from tests.engine.fake_states import CATALOGUE

OUTER = """
flexcell: 1
name: outer
parameters: {after: {type: number, minimum: 0}, name: {type: string, default: x}}
userdata: {given: 1}
outcomes: [good, bad]
success: [good]
root:
  machine:
    initial: inside
    states:
      inside: {behavior: inner.yaml, with: {after: "${after}"}, transitions: {good: good}}
"""
INNER = """
flexcell: 1
name: inner
parameters: {after: {type: number}}
outcomes: [good]
success: [good]
root:
  machine:
    initial: only
    states:
      only: {state: test.Give, with: {after_s: "${after}"}, transitions: {a: good, b: good, c: good}}
"""


@pytest.fixture
def outer(tmp_path: Path) -> Path:
    """A behavior that refers to another, and a cell with a store."""
    (tmp_path / "inner.yaml").write_text(INNER, encoding="utf-8")
    (tmp_path / "cell.yaml").write_text(
        "flexcell: 1\ncell: c\nstore: {kind: sqlite, path: here.db}\n", encoding="utf-8"
    )
    file = tmp_path / "outer.yaml"
    file.write_text(OUTER, encoding="utf-8")
    return file


def planned(file: Path) -> Plan:
    """Plan a behavior."""
    return new_plan(load_behavior(file), CATALOGUE)


@pytest.mark.parametrize(
    ("parameters", "inputs", "message"),
    [
        ({"after": -1.0}, {}, "below the minimum"),
        ({}, {}, "after"),
        ({"after": 1.0, "aftr": 1.0}, {}, "aftr"),
        ({"after": 1.0}, {"gvien": 2}, "there is no userdata key 'gvien'"),
    ],
)
async def test_a_refused_value_leaves_no_run_in_the_journal(
    outer: Path, parameters: dict[str, object], inputs: dict[str, object], message: str
) -> None:
    request = RunRequest(plan=planned(outer), parameters=parameters, inputs=inputs)
    with Journal.open(outer.parent) as journal:
        async with OpenCell(None) as cell:
            with pytest.raises(DocumentError, match=message):
                await CellRunner(cell, journal).start(request)
        assert list_runs(outer.parent) == ()


@pytest.mark.virtual
async def test_the_journal_knows_how_a_run_was_started(outer: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Absolute paths, both seeds, the clock, the operator's rules, and the documents themselves."""
    monkeypatch.chdir(outer.parent)
    plan = planned(Path(outer.name))
    watched = RunOptions(autonomy="low", demand_operator=True)
    with Journal.open(outer.parent, inline=True) as journal:
        async with OpenCell(load_cell("cell.yaml"), seed=5) as cell:
            request = RunRequest(plan=plan, parameters={"after": 2.0}, inputs={"given": 7}, seed=9, supervision=watched)
            prepared = await CellRunner(cell, journal).start(request)
            await prepared.execute()
    origin = read_origin(outer.parent, prepared.run.id)
    assert origin is not None
    assert (origin.behavior, origin.cell) == (str(outer), str(outer.parent / "cell.yaml"))
    assert (origin.store, origin.seed, origin.run_seed) == (str(outer.parent / "here.db"), 5, 9)
    assert (origin.clock, origin.autonomy, origin.demand_operator) == ("virtual", "low", True)
    assert (origin.parameters, origin.inputs) == ({"after": 2.0, "name": "x"}, {"given": 7})
    assert origin.documents == {"outer.yaml": OUTER, "inner.yaml": INNER}


def test_what_it_executed_can_be_read_back_though_the_files_have_gone(outer: Path) -> None:
    behavior = load_behavior(outer)
    plan = new_plan(behavior, CATALOGUE)

    async def main() -> str:
        with Journal.open(outer.parent, inline=True) as journal:
            async with OpenCell(None) as cell:
                prepared = await CellRunner(cell, journal).start(RunRequest(plan=plan, parameters={"after": 0.0}))
                await prepared.execute()
        return prepared.run.id

    run_id = run_virtual(main())
    outer.unlink()
    (outer.parent / "inner.yaml").unlink()
    recorded = read_run(outer.parent, run_id).behavior()
    assert recorded is not None
    assert recorded.meaning == behavior.meaning


@pytest.mark.virtual
async def test_a_run_without_origin_cannot_be_resumed_and_says_so(outer: Path) -> None:
    plan = replace(planned(outer), source=None)
    with Journal.open(outer.parent, inline=True) as journal:
        async with OpenCell(None) as cell:
            prepared = await CellRunner(cell, journal).start(RunRequest(plan=plan, parameters={"after": 0.0}))
            await prepared.execute()
    with pytest.raises(JournalError, match=r"does not record how run outer-.* was started"):
        read_run(outer.parent, prepared.run.id)


@pytest.mark.virtual
async def test_without_a_journal_a_run_is_not_kept(outer: Path) -> None:
    async with OpenCell(None) as cell:
        request = RunRequest(plan=planned(outer), parameters={"after": 0.0})
        prepared = await CellRunner(cell, NullJournal()).start(request)
        assert (await prepared.execute()).outcome == "good"


async def test_a_run_that_is_driven_here_is_not_resumed(outer: Path) -> None:
    plan = planned(outer)
    with Journal.open(outer.parent) as journal:
        async with OpenCell(None) as cell:
            prepared = await CellRunner(cell, journal).start(RunRequest(plan=plan, parameters={"after": 0.0}))
            await prepared.entered()
            found = read_run(outer.parent, prepared.run.id)
            with pytest.raises(ControlError, match=f"process {os.getpid()} executes this run"):
                plan_resume(found, plan, catalogue=CATALOGUE)
            await prepared.execute()


def test_a_run_that_names_what_its_cell_lacks_is_refused(tmp_path: Path) -> None:
    """With the value that it is given, and the position where it is used."""
    (tmp_path / "cell.yaml").write_text(
        "flexcell: 1\ncell: bench\nworld: {kind: mujoco}\n"
        "robots: {left: {model: servo_arm, gripper: {model: servo_claw}}}\n",
        encoding="utf-8",
    )
    file = tmp_path / "b.yaml"
    file.write_text(
        "flexcell: 1\nname: b\noutcomes: [done]\nparameters: {arm: {type: string, default: left}}\n"
        "root: {machine: {initial: a, states: {a: {state: gripper.Open, with: {gripper: '${arm}'}, "
        "transitions: {opened: done, failed: done}}}}}\n",
        encoding="utf-8",
    )
    cell, behavior = load_cell(tmp_path / "cell.yaml"), load_behavior(file)
    require_names(behavior, load_states(), cell, {"arm": "left"})
    with pytest.raises(DocumentError, match="has no robot with a gripper `lft`") as refused:
        require_names(behavior, load_states(), cell, {"arm": "lft"})
    assert str(refused.value.where).endswith("b.yaml:5:80")
    assert refused.value.hint == "did you mean left?"
