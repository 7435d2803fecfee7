"""`flexcell check --fix`: what is evident is written into the file, and nothing of it is ever lost."""

from __future__ import annotations

import json
import os
from pathlib import Path

import pytest

from engine.cli import check_fix
from engine.errors import FlexcellError
from engine.registry import load_states
from tests.engine.cli.command import flexcell

GOOD = """\
# Waits for the part.
flexcell: 1
name: good
outcomes: [finished, failed]
success: [finished]
root:
  machine:
    initial: wait
    states:
      wait:   # as it cools
        state: flow.Wait
        with: {duration_s: 1}
        timeout: {after: 9 s, to: failed}
        transitions: {done: finished}
"""
WRONG = GOOD.replace("flow.Wait", "flow.Wiat").replace("duration_s", "duraton_s")
UNDECIDED = (
    GOOD.replace("flow.Wait", "flow.Decide").replace("{duration_s: 1}", "{condition: true}").replace("done", "true")
)


NESTED = """\
flexcell: 1
name: nested
outcomes: [good, failed]
success: [good]
root:
  machine:
    initial: work
    states:
      work:
        machine:
          initial: one
          states:
            one: {state: flow.Decide, with: {when: true}, transitions: {true: two}}
            two: {state: flow.Decide, with: {when: true}}
        transitions: {true: good, false: failed}
"""


@pytest.fixture
def file(tmp_path: Path) -> Path:
    """A behavior with two slips."""
    made = tmp_path / "x.yaml"
    made.write_text(WRONG, encoding="utf-8")
    return made


def test_slips_are_fixed_and_reported_and_everything_else_stays(file: Path) -> None:
    """A second time there is nothing to do."""
    said = flexcell("check", "x.yaml", "--fix", cwd=file.parent)
    assert said.out.splitlines() == [
        "x.yaml:11:16: fixed: there is no state `flow.Wiat`: Run `flow.Wait` [unknown-state]",
        "x.yaml:12:16: fixed: `flow.Wait` has no parameter `duraton_s`: Rename it to `duration_s` [unknown-parameter]",
    ]
    assert (said.code, said.err, file.read_text(encoding="utf-8")) == (0, "1 checked: 0 errors, 0 warnings\n", GOOD)
    before = (file.stat().st_mtime_ns, file.stat().st_ino)
    again = flexcell("check", "x.yaml", "--fix", cwd=file.parent)
    assert (again.code, again.out, (file.stat().st_mtime_ns, file.stat().st_ino)) == (0, "", before)


def test_outcomes_fall_through_to_those_of_the_same_name_around_them(tmp_path: Path) -> None:
    """Written out, at every level, and no transition that is there is touched."""
    (tmp_path / "x.yaml").write_text(NESTED, encoding="utf-8")
    said = flexcell("check", "x.yaml", "--fix", cwd=tmp_path)
    assert said.code == 0, said.out
    written = (tmp_path / "x.yaml").read_text(encoding="utf-8")
    assert written == NESTED.replace("{true: two}", '{true: two, "false": "false"}').replace(
        "with: {when: true}}", 'with: {when: true}, transitions: {"true": "true", "false": "false"}}'
    )


def test_what_a_person_must_choose_is_left_and_named(file: Path) -> None:
    """With the fixes that the editor offers; `--fix-likely` takes the first."""
    file.write_text(UNDECIDED, encoding="utf-8")
    said = flexcell("check", "x.yaml", "--fix", cwd=file.parent)
    assert (said.code, file.read_text(encoding="utf-8")) == (2, UNDECIDED)
    assert "x.yaml:10:7: not fixed, choose one: Connect `false` to" in said.out
    assert ": error: outcome `false` of `wait` is not connected" in said.out
    likely = flexcell("check", "x.yaml", "--fix-likely", cwd=file.parent)
    assert (likely.code, "fixed: outcome `false` of `wait` is not connected: Connect `false` to" in likely.out) == (
        0,
        True,
    )


def test_machines_read_only_what_is_left(file: Path) -> None:
    said = flexcell("check", "x.yaml", "--fix", "--json", cwd=file.parent)
    assert (said.code, json.loads(said.out), said.err.count(": fixed: ")) == (0, [], 2)


def test_a_read_only_file_is_reported_and_left(file: Path) -> None:
    """Also to whoever may write everywhere; other files are fixed all the same."""
    file.chmod(0o444)
    other = file.with_name("y.yaml")
    other.write_text(WRONG, encoding="utf-8")
    said = flexcell("check", "x.yaml", "y.yaml", "--fix", cwd=file.parent)
    assert "flexcell: x.yaml: the file is read-only (no fix was written" in said.err
    assert (said.code, file.read_text(encoding="utf-8"), other.read_text(encoding="utf-8")) == (2, WRONG, GOOD)


def test_a_file_that_cannot_be_written_whole_is_as_it_was(file: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def full(descriptor: int) -> None:
        raise OSError(28, os.strerror(28))

    monkeypatch.setattr(os, "fsync", full)
    with pytest.raises(FlexcellError, match="the file cannot be written: No space left on device"):
        check_fix.fix_file(file, load_states(file.parent), likely=False)
    assert (file.read_text(encoding="utf-8"), list(file.parent.glob(".*.new"))) == (WRONG, [])


def test_a_file_that_was_changed_meanwhile_is_left(file: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    real = check_fix.fix_text

    def slow(text: str, **options: object) -> object:
        file.write_text(f"{WRONG}# of somebody else\n", encoding="utf-8")
        return real(text, **options)  # type: ignore[arg-type]

    monkeypatch.setattr(check_fix, "fix_text", slow)
    with pytest.raises(FlexcellError, match="changed during the check"):
        check_fix.fix_file(file, load_states(file.parent), likely=False)
    assert file.read_text(encoding="utf-8").endswith("# of somebody else\n")


def test_mode_and_link_of_a_file_stay(file: Path) -> None:
    file.chmod(0o640)
    link = file.with_name("link.yaml")
    link.symlink_to(file)
    assert flexcell("check", "link.yaml", "--fix", cwd=file.parent).code == 0
    assert (link.is_symlink(), file.stat().st_mode & 0o777, file.read_text(encoding="utf-8")) == (True, 0o640, GOOD)


@pytest.mark.parametrize("text", ["a: [", "flexcell: 1\ncell: c\n", "", "- 1\n"])
def test_what_is_no_behavior_is_left(file: Path, text: str) -> None:
    file.write_text(text, encoding="utf-8")
    flexcell("check", "x.yaml", "--fix", cwd=file.parent)
    assert file.read_text(encoding="utf-8") == text


def test_fixes_go_on_around_a_structural_mistake(file: Path) -> None:
    file.write_text(f"{WRONG}flavour: 3\n", encoding="utf-8")
    said = flexcell("check", "x.yaml", "--fix", cwd=file.parent)
    assert (said.code, file.read_text(encoding="utf-8")) == (2, f"{GOOD}flavour: 3\n")
    assert "x.yaml:15:1: error: unknown key `flavour`" in said.out
