"""`flexcell run --coverage`, `flexcell coverage report` and `collect`."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from tests.engine.cli.command import flexcell

BEHAVIOR = """flexcell: 1
name: choose
userdata: {flag: true}
outcomes: [finished, failed]
success: [finished]
root:
  machine:
    initial: choose
    states:
      choose: {state: flow.Decide, with: {when: "${flag}"}, transitions: {"true": finished, "false": failed}}
"""


@pytest.fixture
def behavior(tmp_path: Path) -> Path:
    """A behavior that goes one of two ways."""
    file = tmp_path / "choose.yaml"
    file.write_text(BEHAVIOR, encoding="utf-8")
    return file


def _run(behavior: Path, *more: str) -> None:
    flexcell("run", behavior, "--clock", "virtual", "-q", *more, cwd=behavior.parent)


def test_runs_accumulate_until_all_is_covered(behavior: Path) -> None:
    """`--fail-under` judges with the exit code."""
    _run(behavior, "--journal", "none", "--coverage", "c.json")
    said = flexcell("coverage", "report", "c.json", "--fail-under", "90", cwd=behavior.parent)
    assert (said.code, said.err) == (1, "flexcell: coverage 66.7 % is below the required 90 %\n")
    assert "choose.yaml:10:93: false → failed" in said.out
    _run(behavior, "--journal", "none", "--coverage", "c.json", "--input", "flag=false")
    said = flexcell("coverage", "report", "c.json", "--fail-under", "100", cwd=behavior.parent)
    assert (said.code, "100.0 % covered: 2 of 2 nodes" in said.out) == (0, True)


def test_coverage_is_collected_from_what_was_kept_of_earlier_runs(behavior: Path) -> None:
    """An event log, a recording and a journal; runs of other versions are left out of the journal."""
    _run(behavior, "--events", "run.jsonl", "--record", "run.mcap", "--journal", "runs")
    behavior.write_text(BEHAVIOR.replace('"false": failed', '"false": finished'), encoding="utf-8")
    _run(behavior, "--journal", "runs")
    behavior.write_text(BEHAVIOR, encoding="utf-8")
    logs = ("run.jsonl", "run.mcap", "runs")
    said = flexcell("coverage", "collect", behavior, *logs, "--to", "c.json", cwd=behavior.parent)
    assert (said.code, said.err) == (
        0, "3 runs added to c.json, 1 of other documents skipped: 66.7 % covered by them\n",
    )  # fmt: skip
    (kept,) = json.loads((behavior.parent / "c.json").read_text(encoding="utf-8"))["behaviors"]
    assert {item.get("count", 0) for item in kept["items"]} == {0, 3}


def test_bad_usage_is_exit_code_2_and_one_line(behavior: Path) -> None:
    """It says which file and what is wrong with it."""
    other = behavior.with_name("other.yaml")
    other.write_text(BEHAVIOR.replace('"false": failed', '"false": finished'), encoding="utf-8")
    _run(other, "--journal", "none", "--events", "other.jsonl")
    for arguments, message in (
        (("report", "nowhere.json"), "nowhere.json: cannot read this file"),
        (("report", "choose.yaml"), "choose.yaml: this is not a coverage file"),
        (("collect", "choose.yaml", "choose.yaml"), "choose.yaml:1: this is not an event"),
        (("collect", "choose.yaml", "other.jsonl"), "other.jsonl: this is a run of choose, document"),
    ):
        said = flexcell("coverage", *arguments, cwd=behavior.parent)
        assert (said.code, said.out, said.err.count("\n"), message in said.err) == (2, "", 1, True), said.err


def test_a_run_does_not_start_when_its_coverage_could_not_be_added(behavior: Path) -> None:
    """The file holds another version of the behavior."""
    _run(behavior, "--journal", "none", "--coverage", "c.json")
    behavior.write_text(BEHAVIOR.replace('"false": failed', '"false": finished'), encoding="utf-8")
    said = flexcell("run", behavior, "--coverage", "c.json", "--journal", "runs", cwd=behavior.parent)
    assert (said.code, "two different versions of this document" in said.err) == (2, True)
    assert not (behavior.parent / "runs").exists()
