"""The condition of a breakpoint at its node: syntax, names that are defined there, and whether it is true or false."""

from __future__ import annotations

from pathlib import Path
from textwrap import dedent

import pytest

from engine.check import ConditionCheck, check_condition
from engine.document import load_behavior
from tests.engine.check.checking import CATALOGUE, HEAD

MAIN = """\
parameters: {part: {type: string, default: cup}}
userdata: {tries: 0, poses: []}
root:
  machine:
    initial: home
    states:
      home:
        state: motion.MoveJoints
        with: {robot: left, target: [0]}
        transitions: {reached: learn, failed: bad}
      learn:
        state: motion.LearnJointDmp
        with: {robot: left, recording: r, save_as: d}
        transitions: {learned: inner, failed: bad}
      inner:
        behavior: inner.yaml
        transitions: {good: loop, bad: bad}
      loop:
        foreach:
          items: ${poses}
          as: pose
          index: number
          child: {state: motion.MoveJoints, with: {robot: left, target: "${pose}"}}
        transitions: {exhausted: good, broken: bad}
"""
INNER = """\
userdata: {depth: 0.1}
root: {state: motion.MoveJoints, with: {robot: left, target: [0]}}
"""


@pytest.fixture
def main(tmp_path: Path) -> Path:
    for name, text in {"main": MAIN, "inner": INNER}.items():
        (tmp_path / f"{name}.yaml").write_text(HEAD + dedent(text), encoding="utf-8")
    return tmp_path / "main.yaml"


def _checked(main: Path, path: str, condition: str, *, after: bool = False) -> ConditionCheck:
    return check_condition(load_behavior(main), CATALOGUE, path, condition, after=after)


@pytest.mark.parametrize(
    ("path", "condition"),
    [
        ("root/home", "tries > 1 && part == 'cup'"),
        ("root/home", "${tries > 1}"),
        ("root/inner", "max_rad > 0.1"),
        ("root/loop/child", "number == 2"),
        ("root/inner/root", "depth > 0.0"),
        ("root/*", "whatever > 1"),
        ("root/home", "   "),
        ("root/home", "true"),
    ],
)
def test_what_holds_at_its_node_has_no_problem(main: Path, path: str, condition: str) -> None:
    assert _checked(main, path, condition).problem == ""


@pytest.mark.parametrize(
    ("path", "condition", "problem", "hint"),
    [
        ("root/home", "tries >", "tries >", ""),
        ("root/home", "trys > 1", "`trys` is not defined before `home`", "tries"),
        ("root/home", "max_rad > 0.1", "`max_rad` is not defined before `home`", ""),
        ("root/loop", "number == 2", "`number` is not defined before `loop`", ""),
        ("root/inner/root", "tries > 1", "`tries` is not defined before `root`", "depth"),
        ("root/home", "tries", "this is `0`", "comparison"),
        ("root/home", "tries + 1", "this is an integer", "comparison"),
        ("root/home", "part > 1", "part", ""),
        ("root/*", "tries >", "tries >", ""),
    ],
)
def test_what_does_not_says_why(main: Path, path: str, condition: str, problem: str, hint: str) -> None:
    found = _checked(main, path, condition)
    assert problem in found.problem
    assert hint in found.hint


def test_after_a_node_what_it_writes_is_known(main: Path) -> None:
    assert "max_rad" not in _checked(main, "root/learn", "").names
    assert "max_rad" in _checked(main, "root/learn", "", after=True).names
    assert _checked(main, "root/learn", "max_rad > 0.1", after=True).problem == ""
    assert "after `home`" in _checked(main, "root/home", "max_rad > 0.1", after=True).problem


def test_the_names_are_those_that_may_be_defined_there(main: Path) -> None:
    assert _checked(main, "root/home", "").names == ("part", "poses", "tries")
    assert _checked(main, "root/loop/child", "").names == (
        *("max_rad", "number", "part", "pose", "poses", "rms_rad", "tries"),
    )
    assert _checked(main, "root/inner/root", "").names == ("depth",)
    assert _checked(main, "root/*", "").names == ()
