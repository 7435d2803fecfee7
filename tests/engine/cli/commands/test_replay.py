"""`flexcell run --record` and `flexcell replay`: exit codes, lines, JSON and JUnit of the installed command."""

from __future__ import annotations

import json
import xml.etree.ElementTree as ET
from pathlib import Path

import pytest

from engine.journal import list_runs
from tests.engine.cli.command import CommandOutput, flexcell
from tests.engine.recording.altered_recording import alter_events

RECORDINGS = Path(__file__).parents[3] / "replay"
WAIT = """
flexcell: 1
name: wait
parameters: {pause: {type: number, default: 60, minimum: 0, maximum: 3600, unit: s}}
userdata: {flag: true}
outcomes: [finished, failed]
success: [finished]
root:
  machine:
    initial: wait
    states:
      wait: {state: flow.Wait, with: {duration_s: "${pause}"}, transitions: {done: choose}}
      choose: {state: flow.Decide, with: {when: "${flag}"}, transitions: {"true": finished, "false": failed}}
"""


@pytest.fixture
def project(tmp_path: Path) -> Path:
    """A folder with a behavior."""
    (tmp_path / "wait.yaml").write_text(WAIT, encoding="utf-8")
    return tmp_path


def record(project: Path, *arguments: str) -> CommandOutput:
    """Record a run in virtual time."""
    return flexcell("run", "wait.yaml", "--clock", "virtual", "-q", "--record", "run.mcap", *arguments, cwd=project)


def test_what_was_recorded_replays_the_same(project: Path) -> None:
    assert record(project, "-p", "pause=1800").code == 0
    (project / "wait.yaml").unlink()
    said = flexcell("replay", "run.mcap", cwd=project)
    assert (said.code, said.out, said.err) == (0, "", "run.mcap: the same, 10 events\n")


def test_inputs_of_the_run_are_those_of_the_replay(project: Path) -> None:
    assert record(project, "--input", "flag=false").code == 1
    assert flexcell("replay", "run.mcap", cwd=project).code == 0


def test_a_difference_is_exit_code_4_and_one_line_with_both_sides(project: Path) -> None:
    record(project)
    (project / "changed.yaml").write_text(WAIT.replace("done: choose", "done: failed"), encoding="utf-8")
    said = flexcell("replay", "run.mcap", "--behavior", "changed.yaml", cwd=project)
    assert said.code == 4
    assert said.err.splitlines()[0] == (
        "run.mcap: differs: event 5 at 60.000 s, root: "
        'recorded `wait —done→ choose`; replayed `wait —done→ failed` (target: "choose" ≠ "failed")'
    )


def test_a_changed_default_is_exit_code_4_and_names_the_parameter(project: Path) -> None:
    record(project)
    (project / "changed.yaml").write_text(WAIT.replace("default: 60", "default: 50"), encoding="utf-8")
    said = flexcell("replay", "run.mcap", "--behavior", "changed.yaml", "--json", "--junit", "r.xml", cwd=project)
    (row,) = json.loads(said.out)["replays"]
    assert (said.code, row["status"], row["records"]) == (4, "differs", "verified")
    line = "event 1 at 0.000 s: recorded parameter `pause = 60`, by default; replayed default `pause = 50`"
    assert [each["message"].startswith(line) for each in row["differences"]] == [True]
    assert line in (project / "r.xml").read_text(encoding="utf-8")
    text = flexcell("replay", "run.mcap", "--behavior", "changed.yaml", cwd=project)
    assert (text.code, text.err.startswith(f"run.mcap: differs: {line}")) == (4, True)


def test_an_altered_event_is_exit_code_4_and_named(project: Path) -> None:
    """Beside what comes of it."""
    record(project)
    alter_events(project / "run.mcap", project / "altered.mcap", lambda data: data.replace(b'"done"', b'"gone"'))
    said = flexcell("replay", "altered.mcap", cwd=project)
    assert said.code == 4
    assert "altered.mcap: also differs: event 4 at 60.000 s, root/wait: recorded an event with digest" in said.err
    assert "(the recording was altered after the run)" in said.err


def test_json_and_junit_report_all_of_several(project: Path) -> None:
    record(project)
    (project / "bad.mcap").write_bytes(b"no recording")
    (project / "changed.yaml").write_text(WAIT.replace("done: choose", "done: failed"), encoding="utf-8")
    said = flexcell(
        "replay", "run.mcap", "bad.mcap", "--behavior", "changed.yaml", "--json", "--junit", "r.xml", cwd=project
    )
    assert said.code == 2
    differs, unusable = json.loads(said.out)["replays"]
    assert (differs["status"], differs["difference"]["path"], differs["events"]) == ("differs", "root", 4)
    assert unusable == {
        "recording": "bad.mcap",
        "status": "unusable",
        "error": "bad.mcap: this is not an MCAP file (give a file that --record wrote)",
    }
    suites = ET.parse(project / "r.xml").getroot()
    assert [(suite.get("failures"), suite.get("errors")) for suite in suites] == [("1", "0"), ("0", "1")]
    properties = {each.get("name"): each.get("value") for each in suites.iter("property")}
    assert properties["run"] == differs["run"]
    assert len(properties["document_sha256"] or "") == 64


def test_json_has_the_measures_of_recorded_arms(tmp_path: Path) -> None:
    """Of this one, only joints and frames were recorded, without a description that names the frame of the tool."""
    said = flexcell("replay", RECORDINGS / "test_cylinder.mcap", "--json", cwd=tmp_path)
    (row,) = json.loads(said.out)["replays"]
    assert set(row["measures"]) == {"arm.joint_path_rad"}
    assert 1.0 < row["measures"]["arm.joint_path_rad"] < 100.0


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (
            ("nowhere.mcap",),
            "flexcell: nowhere.mcap: cannot read this file: No such file or directory (check its path)",
        ),
        (("wait.yaml",), "flexcell: wait.yaml: this is not an MCAP file (give a file that --record wrote)"),
        (("run.mcap", "--behavior", "no.yaml"), "no.yaml:1:1: cannot read this file"),
        (("some-run", "--journal", "."), "there is no journal here"),
    ],
)
def test_what_cannot_be_replayed_is_exit_code_2_and_one_line(
    project: Path, arguments: tuple[str, ...], message: str
) -> None:
    record(project)
    said = flexcell("replay", *arguments, cwd=project)
    assert (said.code, said.out, said.err.count("\n")) == (2, "", 1)
    assert message in said.err


def test_a_run_of_the_journal_replays_too(project: Path) -> None:
    flexcell("run", "wait.yaml", "--clock", "virtual", "-q", "--journal", "journal", "-p", "pause=5", cwd=project)
    (run,) = list_runs(project / "journal")
    (project / "wait.yaml").unlink()
    said = flexcell("replay", run.id, "--journal", "journal", cwd=project)
    assert (said.code, said.err) == (0, f"{run.id}: the same, 10 events\n")


def test_a_recording_that_cannot_be_begun_starts_nothing(project: Path) -> None:
    said = flexcell("run", "wait.yaml", "--clock", "virtual", "-q", "--record", "wait.yaml/run.mcap", cwd=project)
    assert (said.code, said.out) == (2, "")
    assert "this file cannot be written" in said.err
    assert said.err.count("\n") == 1
    assert not (project / ".flexcell").exists() or list_runs(project / ".flexcell") == ()


def test_the_result_of_a_run_as_junit(project: Path) -> None:
    said = flexcell(
        "run", "wait.yaml", "--clock", "virtual", "-q", "--junit", "r.xml", "--input", "flag=false", cwd=project
    )
    assert said.code == 1
    (suite,) = ET.parse(project / "r.xml").getroot()
    assert (suite.get("name"), suite.get("failures"), suite.get("time")) == ("wait", "1", "60.000")
    failure = suite.find("./testcase/failure")
    assert failure is not None
    assert failure.get("type") == "failed"


def test_what_is_wrong_with_a_file_to_be_written_is_said_before_the_run(project: Path) -> None:
    """A folder that is missing is made; where a folder stands, no file can."""
    asked = ("run", "wait.yaml", "--clock", "virtual", "-q", "--events", "e.jsonl", "--junit")
    assert flexcell(*asked, "new/folder/r.xml", cwd=project).code == 0
    assert (project / "new" / "folder" / "r.xml").read_bytes().startswith(b"<?xml")
    (project / "e.jsonl").unlink()
    for junit, message in (("new", "the output path is a folder"), ("wait.yaml/r.xml", "cannot be written")):
        said = flexcell(*asked, junit, cwd=project)
        assert (said.code, (project / "e.jsonl").exists()) == (2, False)
        assert message in said.err


def test_a_run_whose_report_finds_no_space_has_been_and_is_reported(project: Path) -> None:
    """Exit code 3, so that no CI takes it for good; what can be told is."""
    said = flexcell("run", "wait.yaml", "--clock", "virtual", "-q", "--junit", "/dev/full", cwd=project)
    assert said.code == 3
    assert "No space left on device" in said.err
    assert "finished" in said.out + said.err
