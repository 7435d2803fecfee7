"""Values under `with` beyond single types: together, by defaults, with units and limits, as entries."""

from __future__ import annotations

from pathlib import Path

import pytest

from engine.check import check_behavior, check_given
from engine.check.cell.entry_references import entry_fields
from engine.document import load_behavior, load_cell, read_signature
from engine.registry import load_states
from engine.state import State
from states.motion.move_joints import MoveJoints
from states.motion.move_linear import MoveLinear
from states.motion.move_pose import MovePose
from tests.engine.check.checking import code_paths, findings_in, findings_in_files, message_of

LINE = """
root:
  machine:
    initial: line
    states:
      line: {state: motion.MoveLinear, with: {robot: left, %s}, transitions: {reached: good, failed: bad}}
"""

LAMP = LINE.replace("motion.MoveLinear", "io.SetOutput").replace("reached", "set")


def test_values_that_do_not_go_together_are_found() -> None:
    """A line takes either a duration or a speed."""
    assert message_of(LINE % "offset_m: [0, 0, 0.1]") == "give either `duration_s` or `speed_m_s`"
    assert code_paths(LINE % "offset_m: [0, 0, 0.1], duration_s: 1, speed_m_s: 1") == ["bad-parameter root/line"]
    assert code_paths(LINE % "offset_m: [0, 0, 0.1], duration_s: 1") == []


def test_a_value_is_tried_with_the_defaults_of_the_behavior() -> None:
    """A default that the state refuses is found, at the value and not at the default."""
    head = "parameters: {v: {type: number, default: %s, unit: m/s}}\n"
    text = LINE % "offset_m: [0, 0, 0.1], speed_m_s: '${v}'"
    assert code_paths(head % "0.1" + text) == []
    (finding,) = findings_in(head % "-0.1" + text)
    assert (finding.code, finding.message) == ("bad-parameter", "parameter `speed_m_s`: -0.1: expected number > 0.0")


def test_a_class_that_breaks_when_it_is_made_does_not_break_the_check() -> None:
    """Two branches are compared by the devices that they would command; one of them cannot be made."""
    text = """
    root:
      concurrency:
        states:
          a: {state: motion.MoveLinear, with: {robot: left}}
          b: {state: motion.MoveJoints, with: {robot: left, target: [0]}}
        conditions: [{good: {a: reached}}]
        otherwise: bad
    """
    assert code_paths(text) == ["bad-parameter root/a"]


@pytest.mark.parametrize(
    ("declared", "expected"),
    [
        ("unit: m/s", []),
        ("unit: mm/s", ["unit-mismatch root/line"]),
        ("label: Speed", ["missing-unit root/line"]),
        ("unit: m/s, minimum: -1", ["range-too-wide root/line"]),
        ("unit: m/s, minimum: 0.1, maximum: 9", []),
    ],
)
def test_a_parameter_is_handed_on_with_its_unit_and_limits(declared: str, expected: list[str]) -> None:
    """Compared with those of the state; only where the value is nothing but the parameter."""
    head = f"parameters: {{v: {{type: number, default: 0.5, {declared}}}}}\n"
    assert code_paths(head + LINE % "offset_m: [0, 0, 0.1], speed_m_s: '${v}'") == expected
    assert code_paths(head + LINE % "offset_m: [0, 0, 0.1], speed_m_s: '${v * 2.0}'") == []


def test_units_and_limits_are_compared_through_references(tmp_path: Path) -> None:
    """With what the other behavior declares."""
    part = "parameters: {v: {type: number, default: 0.5, unit: m/s, maximum: 1}}\n"
    part += LINE % "offset_m: [0, 0, 0.1], speed_m_s: '${v}'"
    main = """
    parameters: {speed: {type: number, default: 0.5, unit: mm/s, maximum: 2}}
    root:
      machine:
        initial: sub
        states:
          sub: {behavior: part.yaml, with: {v: "${speed}"}, transitions: {good: good, bad: bad}}
    """
    assert [f.code for f in findings_in_files(tmp_path, main=main, part=part)] == ["range-too-wide", "unit-mismatch"]


def test_a_parameter_that_nobody_uses_is_reported_when_there_is_no_error() -> None:
    """A mistyped use is enough to be reported."""
    head = "parameters: {v: {type: number, default: 0.5, unit: m/s}}\n"
    assert code_paths(head + LINE % "offset_m: [0, 0, 0.1], duration_s: 1") == ["unused-parameter root"]
    assert code_paths(head + LINE % "offset_m: [0, 0, 0.1], duration_s: '${vv}'") == ["undeclared-name root/line"]


CELL = """
flexcell: 1
cell: bench
store: {kind: sqlite, path: bench.db, seed: entries.yaml}
world: {kind: mujoco}
robots: {left: {model: panda}}
"""
ENTRIES = """
flexcell: 1
joints: {left_home: [0, 0], left_away: [1, 1]}
poses: {left_pick: {xyz: [0, 0, 0]}}
"""


@pytest.mark.parametrize(
    ("entry", "says"),
    [
        ("left_home", ""),
        ("left_hoem", "there is no joints entry `left_hoem` (did you mean left_home?)"),
        ("left_pick", "there is no joints entry `left_pick` (the kind of `left_pick` is pose)"),
        ("${place}", "there is no joints entry `left_pick`"),
    ],
)
def test_an_entry_is_looked_for_in_the_cell_of_the_behavior_by_its_kind(tmp_path: Path, entry: str, says: str) -> None:
    """Also where it is a parameter, by its default."""
    main = f"""
    cell: cell.yaml
    parameters: {{place: {{type: string, default: left_pick}}}}
    root:
      machine:
        initial: home
        states:
          home:
            state: motion.MoveJoints
            with: {{robot: left, target: {{entry: "{entry}"}}}}
            transitions: {{reached: tell, failed: bad}}
          tell: {{state: flow.Log, with: {{message: "${{place}}"}}, transitions: {{done: good}}}}
    """
    findings = findings_in_files(tmp_path, main=main, cell=CELL, entries=ENTRIES)
    assert [finding.code for finding in findings] == (["missing-entry"] if says else [])
    assert all(says in str(finding) for finding in findings)


def test_a_cell_that_cannot_be_read_is_reported_beside_everything_else(tmp_path: Path) -> None:
    """At the key that names it."""
    main = "cell: nowhere.yaml\n" + LINE % "offset_m: [0, 0, 0.1]"
    findings = findings_in_files(tmp_path, main=main)
    assert [finding.code for finding in findings] == ["invalid-cell", "bad-parameter"]
    assert findings[0].position.line == 5


@pytest.mark.parametrize(("state", "kind"), [(MoveJoints, "joints"), (MovePose, "pose"), (MoveLinear, "pose")])
def test_states_mark_the_fields_that_name_entries(state: type[State], kind: str) -> None:
    """With the kind that they read."""
    assert entry_fields(read_signature(state).parameters["target"].type) == {("entry",): kind}


def test_an_entry_that_the_behavior_writes_itself_is_not_missing(tmp_path: Path) -> None:
    """Recorded, learned from and followed in one run; a mistyped recording is still reported."""
    main = """
    cell: cell.yaml
    root:
      machine:
        initial: guide
        states:
          guide: {state: motion.Guide, with: {robot: left, record: led}, transitions: {finished: learn, failed: bad}}
          learn:
            state: motion.LearnJointDmp
            with: {robot: left, recording: %s, save_as: swing}
            transitions: {learned: follow, failed: bad}
          follow:
            state: motion.FollowJointDmp
            with: {robot: left, dmp: {entry: swing}}
            transitions: {reached: good, failed: bad}
    """
    assert findings_in_files(tmp_path, main=main % "led", cell=CELL, entries=ENTRIES) == ()
    (found,) = findings_in_files(tmp_path, main=main % "lad", cell=CELL, entries=ENTRIES)
    assert (found.code, found.path, found.hint) == ("missing-entry", "root/learn", "did you mean led?")


def test_the_parameters_of_a_run_are_tried_instead_of_the_defaults(tmp_path: Path) -> None:
    """A run that would fail at a node far inside is refused at its start, with the value and what would fit."""
    text = LAMP % "device: '${device}', value: true"
    file = tmp_path / "main.yaml"
    head = "flexcell: 1\nname: main\noutcomes: [good, bad]\nsuccess: [good]\n"
    declared = "parameters: {device: {type: string, default: gripper}}\n"
    file.write_text(head + declared + text, encoding="utf-8")
    behavior, catalogue = load_behavior(file), load_states()
    assert check_behavior(behavior, catalogue, parameters={"device": "linear_axis"}) == ()
    (finding,) = check_behavior(behavior, catalogue, parameters={"device": "grippr"})
    assert finding.message == "parameter `device`: 'grippr': there is no choice 'grippr' (did you mean gripper?)"
    cell = load_cell(Path("behaviors/cells/dual_panda.yaml"))
    found = check_given(behavior, catalogue, cell, {"device": "grippr"})
    assert found[0].code == "bad-parameter"
