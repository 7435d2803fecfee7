"""`flexcell run --substitutes`: told at the end, kept by journal and recording, so resumed and replayed."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from engine.event import NodeEntered
from tests.engine.cli.command import flexcell
from tests.engine.cli.process import JOURNAL, events_in, run_id_in

BEHAVIOR = """
flexcell: 1
name: rounds
outcomes: [finished, failed]
success: [finished]
userdata: {width: 0}
root:
  machine:
    initial: read
    states:
      read:
        state: gripper.Grasp
        with: {gripper: left/gripper, width_m: 0.03, force_n: 20}
        out: {width_m: width}
        transitions: {held: wait, missed: read, failed: failed}
      wait: {state: flow.Wait, with: {duration_s: 3}, transitions: {done: tell}}
      tell: {state: flow.Log, with: {message: "width ${width}"}, transitions: {done: finished}}
"""
SUBSTITUTES = """
flexcell: 1
substitutes:
  - {at: root/read, script: [{outcome: missed, after: 1 s}, {outcome: held, after: 1 s, outputs: {width_m: 0.03}}]}
"""


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """A behavior that asks a gripper which is not there, and what stands in for that."""
    (tmp_path / "rounds.yaml").write_text(BEHAVIOR, encoding="utf-8")
    (tmp_path / "substitutes.yaml").write_text(SUBSTITUTES, encoding="utf-8")
    return tmp_path


def _run(folder: Path, *more: str) -> dict[str, object]:
    order = ("run", "rounds.yaml", "--substitutes", "substitutes.yaml", "--clock", "virtual", "--json", *more)
    said = flexcell(*order, cwd=folder)
    assert said.code == 0, said.err
    return json.loads(said.out)


def test_what_stood_in_is_reported(folder: Path) -> None:
    result = _run(folder)
    assert (result["outcome"], result["duration_s"], result["stood_in_for"]) == ("finished", 5.0, ["root/read"])
    assert result["userdata"] == {"width": 0.03}
    shown = flexcell("run", "rounds.yaml", "--substitutes", "substitutes.yaml", "--clock", "virtual", cwd=folder)
    assert "substituted nodes: root/read" in shown.err
    kinds = {event.path: event.kind for event in events_in(folder) if isinstance(event, NodeEntered)}
    assert kinds["root/read"] == "substitute"


def test_a_recording_is_replayed_with_them(folder: Path) -> None:
    _run(folder, "--record", "run.mcap")
    said = flexcell("replay", "run.mcap", cwd=folder)
    assert said.code == 0, said.err
    (folder / "rounds.yaml").write_text(BEHAVIOR.replace("width $", "changed $"), encoding="utf-8")
    changed = flexcell("replay", "run.mcap", "--behavior", "rounds.yaml", cwd=folder)
    assert changed.code == 4
    assert "differs: event 13" in changed.err


def test_an_interrupted_run_goes_on_with_them(folder: Path) -> None:
    (folder / "crash.yaml").write_text("flexcell: 1\nfaults: [{crash: {at_event: 5}}]\n", encoding="utf-8")
    order = ("run", "rounds.yaml", "--substitutes", "substitutes.yaml", "--clock", "virtual", "-q")
    assert flexcell(*order, "--faults", "crash.yaml", cwd=folder).code == -9
    said = flexcell("resume", run_id_in(folder), "--clock", "virtual", "--json", cwd=folder)
    assert said.code == 0, said.err
    assert json.loads(said.out)["stood_in_for"] == ["root/read"]
    shown = flexcell("runs", "show", run_id_in(folder), "--journal", JOURNAL, "--json", cwd=folder)
    assert json.loads(shown.out)["userdata"] == {"width": 0.03}


def test_what_does_not_fit_starts_nothing(folder: Path) -> None:
    (folder / "substitutes.yaml").write_text(
        SUBSTITUTES.replace("outcome: missed", "outcome: misssed"), encoding="utf-8"
    )
    said = flexcell("run", "rounds.yaml", "--substitutes", "substitutes.yaml", cwd=folder)
    assert said.code == 2
    assert "substitutes.yaml:4:" in said.err
    assert "did you mean missed" in said.err


def test_coverage_counts_what_was_stood_in_for_as_the_rest(folder: Path) -> None:
    """It is that of the behavior as it is, so that runs with and without substitutes add up."""
    _run(folder, "--coverage", "coverage.json")
    report = flexcell("coverage", "report", "coverage.json", "--format", "json", cwd=folder)
    assert report.code == 0, report.err
    assert "root/read" in report.out


def test_its_schema_is_printed(folder: Path) -> None:
    said = flexcell("schema", "substitutes", cwd=folder)
    assert json.loads(said.out)["title"] == "flexcell substitutes document"
