"""`flexcell runs compare` tells what differs between two runs, `flexcell runs trend` how the last ones went."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from tests.engine.cli.command import flexcell
from tests.engine.cli.process import runs_in

PICK = """
flexcell: 1
name: pick
parameters: {limit: {type: number, default: 1.0}, long: {type: number, default: 1.0}}
userdata: {force: 0.0}
outcomes: [finished, failed]
success: [finished]
root:
  machine:
    initial: press
    states:
      press: {state: flow.SetValue, with: {value: "${limit * 2.0}"}, out: {value: force}, transitions: {done: wait}}
      wait: {state: flow.Wait, with: {duration_s: "${long}"}, transitions: {done: judge}}
      judge: {state: flow.Decide, with: {when: "${force < 3.0}"}, transitions: {"true": finished, "false": failed}}
"""


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A journal with a good run, another good one that took longer, and one that failed."""
    made = tmp_path_factory.mktemp("pick")
    (made / "pick.yaml").write_text(PICK)
    for given in (("limit=1.0", "long=1.0"), ("limit=1.0", "long=3.0"), ("limit=2.0", "long=1.0")):
        parameters = [each for value in given for each in ("-p", value)]
        flexcell("run", "pick.yaml", "--clock", "virtual", "-q", *parameters, cwd=made)
    return made


def test_a_run_is_compared_with_the_last_good_one(folder: Path) -> None:
    """The second one, which the third diverges from in what it decides."""
    _, good, bad = (run.id for run in runs_in(folder))
    output = flexcell("runs", "compare", bad, cwd=folder)
    assert output.code == 0, output.err
    lines = output.out.splitlines()
    assert lines[0].startswith(f"left  {good}: pick, started ")
    assert lines[1].startswith(f"right {bad}: pick, started ")
    assert lines[2] == (
        "first divergence: root/judge ended with true in the left run, and ended with false in the right run"
        " (left at 3.000 s, right at 1.000 s)"
    )
    assert "  parameters.limit: 1.0 → 2.0" in lines
    assert "  root/press wrote force: 2.0 → 4.0" in lines
    durations = next(line.split() for line in lines if line.split()[:1] == ["root/wait"])
    assert durations == ["root/wait", "1", "3.000", "1.000", "-2.000"]


def test_two_runs_that_went_the_same_way_do_not_diverge(folder: Path) -> None:
    """Though they took different times; as JSON for scripts."""
    first, second, _ = (run.id for run in runs_in(folder))
    output = json.loads(flexcell("runs", "compare", first, second, "--json", cwd=folder).out)
    assert (output["left"]["id"], output["right"]["id"], output["divergence"]) == (first, second, None)
    assert [each["at"] for each in output["settings"]] == ["parameters.long"]
    assert {each["path"]: each["duration_right_s"] for each in output["nodes"]}["root/wait"] == 3.0


def test_the_first_good_run_has_none_before_it(folder: Path) -> None:
    """Which is said with what to do."""
    output = flexcell("runs", "compare", runs_in(folder)[0].id, cwd=folder)
    assert output.code == 2
    assert "no run of 'pick' before" in output.err
    assert "give the run to compare it with" in output.err


def test_the_last_runs_of_a_behavior_have_a_trend(folder: Path) -> None:
    """By its name or its document; durations are those of good runs."""
    output = flexcell("runs", "trend", "pick", cwd=folder)
    assert output.code == 0, output.err
    lines = output.out.splitlines()
    assert lines[0] == "pick: 2 of 3 runs succeeded, 1 failed"
    table = {line.split()[0]: line.split()[1:] for line in lines[2:]}
    assert table["root/wait"] == ["2", "2.000", "1.500", "to", "2.500", "1.000", "3.000", "1.000"]
    one = json.loads(flexcell("runs", "trend", "pick.yaml", "--last", "1", "--json", cwd=folder).out)
    assert (one["succeeded"], one["failed"], one["known"], one["duration"]) == (0, 1, 3, None)


def test_a_behavior_that_never_ran_has_no_trend(folder: Path) -> None:
    """The journal may have one with nearly that name."""
    output = flexcell("runs", "trend", "pikc", cwd=folder)
    assert output.code == 2
    assert "the journal has no run of 'pikc'" in output.err
    assert "pick" in output.err
