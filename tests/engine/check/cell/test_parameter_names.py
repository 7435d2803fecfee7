"""What the parameters of a behavior name: declared or inferred, and looked for in the cell and its store."""

from __future__ import annotations

from pathlib import Path

import pytest

from engine.check import Finding, check_given, parameter_naming
from engine.document import load_behavior, load_cell
from tests.engine.check.cell.test_cell_name_checks import CELL
from tests.engine.check.checking import CATALOGUE, findings_in_files

NODES = """
root:
  machine:
    initial: it
    states:
      it:
        state: gripper.Open
        with: {gripper: "${tool}"}
        transitions: {opened: there, failed: bad}
      there:
        state: motion.MoveJoints
        with: {robot: "${arm}", target: {entry: "${place}"}}
        transitions: {reached: good, failed: bad}
"""
ENTRIES = """
flexcell: 1
joints: {home: [0, 0, 0, -1, 0, 1, 0]}
"""


def texts(found: tuple[Finding, ...]) -> list[str]:
    """Code, line and message of each finding."""
    return [f"{each.code} {each.position.line}: {each.message} ({each.hint})" for each in found]


def findings(folder: Path, parameters: str, *, nodes: str = NODES, **files: str) -> tuple[Finding, ...]:
    """Check the behavior with these parameters in the bench cell."""
    main = f"cell: cell.yaml\n{parameters}{nodes}"
    cell = f"{CELL}store: {{kind: sqlite, path: bench.db, seed: entries.yaml}}\n"
    return findings_in_files(folder, main=main, cell=cell, entries=ENTRIES, **files)


def test_a_default_that_the_cell_does_not_have_is_found_where_it_is_declared(tmp_path: Path) -> None:
    declared = """parameters:
  arm: {type: string, cell_name: robot, default: lft}
  tool: {type: string, cell_name: gripper, default: right}
  place: {type: string, entry: joints, default: hme}
"""
    lines = texts(findings(tmp_path, declared))
    assert [line.partition(" ")[0] for line in lines] == ["unknown-in-cell", "unknown-in-cell", "missing-entry"]
    assert "the cell bench has no robot `lft`, the default of the parameter `arm` (did you mean left?)" in lines[0]
    assert "has no robot with a gripper `right`, the default of the parameter `tool`" in lines[1]
    assert "there is no joints entry `hme`, the default of the parameter `place` (did you mean home?)" in lines[2]


def test_what_the_cell_has_is_no_finding(tmp_path: Path) -> None:
    declared = """parameters:
  arm: {type: string, cell_name: robot, default: left, choices: [left, right]}
  tool: {type: string, cell_name: gripper, default: left}
  place: {type: string, entry: joints, default: home}
"""
    assert texts(findings(tmp_path, declared)) == []


def test_a_choice_that_the_cell_does_not_have_may_be_for_another_cell(tmp_path: Path) -> None:
    declared = """parameters:
  arm: {type: string, cell_name: robot, default: left, choices: [left, third]}
  tool: {type: string, default: left}
  place: {type: string, default: home}
"""
    (line,) = texts(findings(tmp_path, declared))
    assert line.startswith("maybe-unknown-in-cell ")
    assert "a choice of the parameter `arm`" in line


@pytest.mark.parametrize(
    ("spec", "message"),
    [
        ("{type: number, cell_name: robot, default: 1}", "parameter `arm` is a number and names something"),
        ("{type: string, cell_name: robto, default: left}", "`robto` is no kind of thing of a cell"),
        ("{type: string, cell_name: robot, entry: joints, default: left}", "names a robot and an entry"),
    ],
)
def test_a_declaration_without_meaning_is_found(tmp_path: Path, spec: str, message: str) -> None:
    rest = "  tool: {type: string, default: left}\n  place: {type: string, default: home}\n"
    found = findings(tmp_path, f"parameters:\n  arm: {spec}\n{rest}")
    assert message in "\n".join(each.message for each in found if each.code == "bad-declaration")


def test_a_value_that_is_given_to_a_run_is_looked_for_too(tmp_path: Path) -> None:
    declared = """parameters:
  arm: {type: string, cell_name: robot, default: left}
  tool: {type: string, default: left}
  place: {type: string, default: home}
"""
    findings(tmp_path, declared)
    behavior, cell = load_behavior(tmp_path / "main.yaml"), load_cell(tmp_path / "cell.yaml")
    found = check_given(behavior, CATALOGUE, cell, {"arm": "middle"})
    assert found[-1].message == "the cell bench has no robot `middle`, the value of the parameter `arm`"


def test_a_value_that_is_no_text_names_nothing(tmp_path: Path) -> None:
    declared = """parameters:
  arm: {type: string, cell_name: robot, default: left}
  tool: {type: string, cell_name: gripper, default: left}
  place: {type: list, entry: joints, default: [home]}
"""
    nodes = NODES.replace('{entry: "${place}"}', '"${place}"')
    assert "bad-declaration" in {each.code for each in findings(tmp_path, declared, nodes=nodes)}


def naming(folder: Path, parameters: str, *, nodes: str = NODES, **files: str) -> dict[str, dict[str, object]]:
    """Return what the parameters name."""
    findings(folder, parameters, nodes=nodes, **files)
    found = parameter_naming(load_behavior(folder / "main.yaml"), CATALOGUE)
    return {name: dict(says) for name, says in found.items()}


PLAIN = """parameters:
  arm: {type: string, default: left}
  tool: {type: string, default: left}
  place: {type: string, default: home}
"""


def test_what_a_parameter_names_is_inferred_from_the_states_that_take_it(tmp_path: Path) -> None:
    assert naming(tmp_path, PLAIN) == {
        "arm": {"cell_name": "robot"},
        "tool": {"cell_name": "gripper"},
        "place": {"entry": "joints"},
    }


def test_a_parameter_that_names_two_kinds_or_is_only_a_part_of_a_name_is_not_inferred(tmp_path: Path) -> None:
    both = NODES.replace('"${tool}"', '"${arm}"').replace('"${place}"', '"${place + tool}"')
    assert naming(tmp_path, PLAIN, nodes=both) == {}


def test_a_declaration_comes_before_what_is_inferred(tmp_path: Path) -> None:
    declared = PLAIN.replace("arm: {type: string", "arm: {type: string, cell_name: gripper")
    assert naming(tmp_path, declared)["arm"] == {"cell_name": "gripper"}


def test_it_is_inferred_through_a_behavior_that_is_referred_to(tmp_path: Path) -> None:
    outer = """
root:
  machine:
    initial: it
    states:
      it: {behavior: inner.yaml, with: {arm: "${side}"}, transitions: {good: good, bad: bad}}
"""
    inner = f"cell: cell.yaml\n{PLAIN}{NODES}"
    parameters = "parameters:\n  side: {type: string, default: left}"
    assert naming(tmp_path, parameters, nodes=outer, inner=inner) == {"side": {"cell_name": "robot"}}
