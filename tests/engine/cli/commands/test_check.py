"""`flexcell check`: broken documents give one clear line with a position, exit 2, in under a second."""

from __future__ import annotations

import json
import time
from pathlib import Path

import pytest

from tests.engine.cli.command import flexcell

GOOD = """\
flexcell: 1
name: good
outcomes: [finished]
success: [finished]
root:
  machine:
    initial: wait
    states:
      wait: {state: flow.Wait, with: {duration_s: 1}, transitions: {done: finished}}
"""
BROKEN = {
    "unknown state": (GOOD.replace("flow.Wait", "flow.Wiat"), "9:21", "no state `flow.Wiat` (did you mean flow.Wait"),
    "bad type": (GOOD.replace("duration_s: 1", "duration_s: soon"), "9:51", "duration_s"),
    "self reference": (GOOD.replace("state: flow.Wait, with: {duration_s: 1}", "behavior: x.yaml"), "9:2", "circular"),
    "alias bomb": ("a: &a [1]\nb: [*a, *a]\n", "1:4", "anchor"),
    "duplicate keys": (GOOD + "name: twice\n", "10:1", "name"),
    "deep nesting": ("a: " + "[" * 5_000_000 + "]" * 5_000_000, "1:", ""),
    "deep nesting, small": ("a: " + "[" * 50_000 + "]" * 50_000, "1:", "64"),
    "garbage bytes": ("\x00\x01\x02", "1:1", ""),
    "empty": ("", "1:1", ""),
    "a list": ("- 1\n", "1:1", ""),
}


@pytest.mark.parametrize("name", BROKEN)
def test_a_broken_document_is_one_clear_line(tmp_path: Path, name: str) -> None:
    """Position, reason, exit code 2, and no traceback; no hostile text takes long."""
    text, position, reason = BROKEN[name]
    file = tmp_path / "x.yaml"
    file.write_text(text, encoding="utf-8")
    began = time.process_time()
    said = flexcell("check", "x.yaml", cwd=tmp_path)
    errors = [line for line in said.out.splitlines() if ": error: " in line]
    assert (said.code, len(errors)) == (2, 1), said
    assert errors[0].startswith(f"x.yaml:{position}"), errors[0]
    assert reason in errors[0]
    assert "Traceback" not in said.err
    assert time.process_time() - began < 1.0


def test_a_good_document_is_exit_code_0(tmp_path: Path) -> None:
    """Nothing on stdout, a summary on stderr."""
    (tmp_path / "good.yaml").write_text(GOOD, encoding="utf-8")
    said = flexcell("check", "good.yaml", cwd=tmp_path)
    assert (said.code, said.out, said.err) == (0, "", "1 checked: 0 errors, 0 warnings\n")


def test_machines_read_json_github_and_sarif(tmp_path: Path) -> None:
    """The same finding in three forms."""
    (tmp_path / "bad.yaml").write_text(GOOD.replace("done: finished", "done: nowhere"), encoding="utf-8")
    findings = json.loads(flexcell("check", "bad.yaml", "--json", cwd=tmp_path).out)
    (finding,) = [finding for finding in findings if finding["severity"] == "error"]
    github = flexcell("check", "bad.yaml", "--format", "github", cwd=tmp_path).out
    sarif = json.loads(flexcell("check", "bad.yaml", "--format", "sarif", cwd=tmp_path).out)
    assert (finding["file"], finding["line"], finding["code"]) == ("bad.yaml", 9, "unknown-target")
    assert f"::error file=bad.yaml,line=9,col={finding['column']},title=unknown-target::" in github
    results = {result["ruleId"]: result for result in sarif["runs"][0]["results"]}
    region = results["unknown-target"]["locations"][0]["physicalLocation"]["region"]
    assert region == {"startLine": 9, "startColumn": finding["column"]}
    assert finding["page"] == "docs/findings/unknown-target.md"


def test_the_text_form_says_how_to_learn_more(tmp_path: Path) -> None:
    """The last line on stderr is the command that explains the first finding; the command prints its page."""
    (tmp_path / "bad.yaml").write_text(GOOD.replace("flow.Wait", "flow.Wiat"), encoding="utf-8")
    said = flexcell("check", "bad.yaml", cwd=tmp_path)
    assert said.err.splitlines() == [
        "1 checked: 1 error, 0 warnings",
        "to explain a finding: flexcell check --explain unknown-state",
    ]
    page = (Path(__file__).resolve().parents[4] / "docs" / "findings" / "unknown-state.md").read_text(encoding="utf-8")
    explained = flexcell("check", "--explain", "unknown-state", cwd=tmp_path)
    assert (explained.code, explained.out) == (0, page)


def test_a_kind_of_finding_that_is_not_there_is_bad_usage(tmp_path: Path) -> None:
    """One line with a near name; so is to check nothing."""
    said = flexcell("check", "--explain", "unknown-stat", cwd=tmp_path)
    assert (said.code, "did you mean unknown-state" in said.err) == (2, True)
    assert flexcell("check", cwd=tmp_path).code == 2


def test_the_entries_of_the_behaviors_own_cell_are_known(tmp_path: Path) -> None:
    """The command line finds them as the editor does."""
    home = "{state: motion.MoveJoints, with: {robot: left, target: {entry: hom}}"
    home += ", transitions: {reached: finished, failed: finished}}"
    text = GOOD.replace("name: good", "name: good\ncell: cell.yaml").replace("initial: wait", "initial: home")
    (tmp_path / "b.yaml").write_text(text.split("      wait:")[0] + f"      home: {home}\n", encoding="utf-8")
    cell = "flexcell: 1\ncell: bench\nworld: {kind: mujoco}\nrobots: {left: {model: panda}}\n"
    (tmp_path / "cell.yaml").write_text(cell + "store: {kind: sqlite, path: x.db, seed: e.yaml}\n", encoding="utf-8")
    (tmp_path / "e.yaml").write_text("flexcell: 1\njoints: {home: [0]}\n", encoding="utf-8")
    (finding,) = json.loads(flexcell("check", "b.yaml", "--json", cwd=tmp_path).out)
    assert (finding["code"], finding["hint"]) == ("missing-entry", "did you mean home?")


def test_cells_and_entries_are_checked_as_documents_of_their_own(tmp_path: Path) -> None:
    """Each with its own findings; `--cell` says in which cell behaviors and entries are."""
    (tmp_path / "cell.yaml").write_text(
        "flexcell: 1\ncell: bench\nworld: {kind: mujoco}\nrobots: {left: {model: pandda}}\n", encoding="utf-8"
    )
    (tmp_path / "e.yaml").write_text("flexcell: 1\nposes: {up: {xyz: [0, 0, 1], frame: plat}}\n", encoding="utf-8")
    wait = "state: flow.Wait, with: {duration_s: 1}, transitions: {done: finished}"
    move = "state: magnet.Off, with: {magnet: lft}, transitions: {released: finished, failed: finished}"
    (tmp_path / "b.yaml").write_text(GOOD.replace(wait, move), encoding="utf-8")
    said = flexcell("check", "cell.yaml", "e.yaml", "b.yaml", cwd=tmp_path)
    assert (said.code, said.out) == (
        2,
        "cell.yaml:4:24: error: there is no robot model `pandda` (did you mean panda?) [unknown-model]\n",
    )
    said = flexcell("check", "e.yaml", "b.yaml", "--cell", "cell.yaml", cwd=tmp_path)
    assert [line.partition(": ")[2] for line in said.out.splitlines()] == [
        "error: the cell bench has no frame `plat` (known: world) [unknown-in-cell]",
        "error: the cell bench has no robot with a magnet `lft` (there are none) [unknown-in-cell]",
    ]
    said = flexcell("check", "b.yaml", "--cell", "none.yaml", cwd=tmp_path)
    assert (said.code, "none.yaml:1:1" in said.err, "Traceback" in said.err) == (2, True, False)


def test_documents_of_runs_are_checked_with_what_they_name(tmp_path: Path) -> None:
    (tmp_path / "good.yaml").write_text(GOOD, encoding="utf-8")
    documents = {
        "sweep.yaml": "behavior: good.yaml\nfactors: {parameters.sped: {values: [1]}}\n",
        "right.yaml": "behavior: good.yaml\nfaults: faults.yaml\n",
        "faults.yaml": 'faults:\n  - {at: "**", hang: {}}\n',
        "substitutes.yaml": "substitutes:\n  - {at: root/wait}\n",
    }
    for name, text in documents.items():
        (tmp_path / name).write_text(f"flexcell: 1\n{text}", encoding="utf-8")
    said = flexcell("check", *documents, cwd=tmp_path)
    first, second = said.out.splitlines()
    assert (said.code, said.err.startswith("4 checked: 2 errors")) == (2, True)
    assert first.startswith("sweep.yaml:3:11: error: the behavior has no parameter `sped`")
    assert second.startswith("substitutes.yaml:3:5: error: ")
