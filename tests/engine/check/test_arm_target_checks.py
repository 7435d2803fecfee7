"""Arms are put to the targets of a behavior in their cell as it is drawn."""

from __future__ import annotations

from pathlib import Path

import pytest

from engine.check import Finding
from engine.cli.commands.check import TargetLevel, findings_of
from engine.document.state_catalogue import find_state
from engine.document.text import yaml_source
from engine.registry import load_states

CATALOGUE = load_states()
CELL = """
flexcell: 1
cell: bench
world: {kind: mujoco}
store: {kind: sqlite, path: store.db, seed: entries.yaml}
robots:
  left: {model: panda, gripper: {model: panda_hand}, base: {xyz: [0, 0, 0]}}
  small: {model: servo_arm, base: {xyz: [-0.6, 0, 0]}}
  right: {model: panda, gripper: {model: panda_hand}, base: {xyz: [0.9, 0, 0], rpy: [0, 0, 3.14159]}}
fixtures:
  table: {shape: box, size_m: [2.4, 1.2, 0.04], at: {xyz: [0, 0, -0.02]}}
  post: {shape: box, size_m: [0.1, 0.1, 0.5], at: {xyz: [0.4, -0.3, 0.25]}}
  foam: {shape: box, size_m: [0.1, 0.1, 0.3], at: {xyz: [0.4, 0.3, 0.15]}, spring: {stiffness_n_m: 500}}
frames:
  post_top: {parent: post, at: {xyz: [0, 0, 0.25]}}
parts:
  peg: {shape: box, size_m: [0.03, 0.03, 0.2], mass_kg: 0.1, at: {xyz: [0.5, 0.0, 0.1]}}
"""
ENTRIES = """
flexcell: 1
poses:
  far: {xyz: [2.0, 0.0, 0.3], xyzw: [1, 0, 0, 0], frame: world}
  near: {xyz: [0.5, 0.0, 0.3], xyzw: [1, 0, 0, 0], frame: world}
joints:
  folded: [0.0, 1.7, 0.0, -2.9, 0.0, 0.5, 0.0]
"""
DOWN = "xyzw: [1, 0, 0, 0]"


def found(folder: Path, *nodes: str, level: TargetLevel = "warning", head: str = "") -> tuple[Finding, ...]:
    """Check a machine of nodes, each a state with its parameters, one after the other."""
    (folder / "cell.yaml").write_text(CELL, encoding="utf-8")
    (folder / "entries.yaml").write_text(ENTRIES, encoding="utf-8")
    lines = ["flexcell: 1", "name: test", "cell: cell.yaml", "outcomes: [good]", "success: [good]", head, "root:"]
    lines += ["  machine:", "    initial: n0", "    states:"]
    for index, node in enumerate(nodes):
        name, _, values = node.partition(" ")
        outcomes = find_state(CATALOGUE, name).outcomes
        to = f"n{index + 1}" if index + 1 < len(nodes) else "good"
        transitions = ", ".join(f"{outcome}: {to}" for outcome in outcomes)
        lines.append(f"      n{index}: {{state: {name}, with: {{{values}}}, transitions: {{{transitions}}}}}")
    (folder / "main.yaml").write_text("\n".join(lines), encoding="utf-8")
    findings = findings_of(folder / "main.yaml", CATALOGUE, targets=level)
    assert [each for each in findings if each.severity == "error" and "target" not in each.code] == []
    return tuple(each for each in findings if "target" in each.code)


@pytest.mark.parametrize(
    ("node", "expected"),
    [
        # In reach or not, by every motion that has a target.
        (f"motion.MovePose robot: left, target: {{xyz: [0.5, 0, 0.3], {DOWN}}}", ""),
        (f"motion.MovePose robot: left, target: {{xyz: [1.6, 0, 0.3], {DOWN}}}", "unreachable-target"),
        (f"motion.MoveFree robot: left, pose: {{xyz: [1.6, 0, 0.3], {DOWN}}}", "unreachable-target"),
        (f"motion.PlanMotion robot: left, pose: {{xyz: [1.6, 0, 0.3], {DOWN}}}", "unreachable-target"),
        (f"motion.MoveLinear robot: left, speed_m_s: 1, target: {{xyz: [1.6, 0, 0.3], {DOWN}}}", "unreachable-target"),
        (f"motion.FollowWaypoints robot: left, waypoints: [{{pose: {{xyz: [0.5, 0, 0.3], {DOWN}}}}}]", ""),
        (
            f"motion.FollowWaypoints robot: left, waypoints: [{{pose: {{xyz: [1.6, 0, 0.3], {DOWN}}}}}]",
            "unreachable-target",
        ),
        # The same place of another arm.
        (f"motion.MovePose robot: right, target: {{xyz: [1.4, 0, 0.3], {DOWN}}}", ""),
        # Offset and approach count.
        (
            f"motion.MovePose robot: left, target: {{xyz: [0.5, 0, 0.3], {DOWN}}}, offset_m: [1, 0, 0]",
            "unreachable-target",
        ),
        (f"motion.MoveFree robot: left, pose: {{xyz: [0.5, 0, 0.9], {DOWN}}}, back_m: 0.9", "unreachable-target"),
        # In a named frame of the cell, which stands on the post.
        (f"motion.MovePose robot: left, target: {{xyz: [0, 0, 0.1], {DOWN}, frame: post_top}}", ""),
        (f"motion.MovePose robot: left, target: {{xyz: [1, 0, 0.1], {DOWN}, frame: post_top}}", "unreachable-target"),
        (f"motion.MovePose robot: left, target: {{xyz: [0, 0, -0.1], {DOWN}, frame: post_top}}", "target-in-collision"),
        # In the frame of the base; in other frames nobody knows.
        (f"motion.MovePose robot: right, target: {{xyz: [0.5, 0, 0.3], {DOWN}, frame: right/panda_link0}}", ""),
        (
            f"motion.MovePose robot: right, target: {{xyz: [1.4, 0, 0.3], {DOWN}, frame: right/panda_link0}}",
            "unreachable-target",
        ),
        # What counts of the pose.
        ("motion.MovePose robot: small, target: {xyz: [-0.4, 0.0, 0.2], xyzw: [1, 0, 0, 0]}", "unreachable-target"),
        # In fixtures, in itself, in a part.
        (f"motion.MovePose robot: left, target: {{xyz: [0.5, 0, -0.03], {DOWN}}}", "target-in-collision"),
        (f"motion.MovePose robot: left, target: {{xyz: [0.5, 0, 0.006], {DOWN}}}", ""),
        (f"motion.MovePose robot: left, target: {{xyz: [0.4, -0.3, 0.3], {DOWN}}}", "target-in-collision"),
        (f"motion.MovePose robot: left, target: {{xyz: [0.4, 0.3, 0.2], {DOWN}}}", ""),
        (f"motion.MovePose robot: left, target: {{xyz: [0.5, 0.0, 0.1], {DOWN}}}", ""),
        ("motion.MoveJoints robot: left, target: [0, -0.785, 0, -2.356, 0, 1.571, 0.785]", ""),
        ("motion.MoveJoints robot: left, target: [0.0, 1.7, 0.0, -2.9, 0.0, 0.5, 0.0]", "target-in-collision"),
        # Entries with the values of the seed.
        ("motion.MovePose robot: left, target: {entry: near}", ""),
        ("motion.MovePose robot: left, target: {entry: far}", "unreachable-target"),
        ("motion.MoveJoints robot: left, target: {entry: folded}", "target-in-collision"),
        ("motion.MoveLinear robot: left, speed_m_s: 1, joints: {entry: folded}", "target-in-collision"),
    ],
)
def test_a_target_that_an_arm_cannot_be_at_is_reported(tmp_path: Path, node: str, expected: str) -> None:
    """With its code, at its place, as a warning."""
    findings = found(tmp_path, node)
    assert [each.code for each in findings] == ([expected] if expected else [])
    assert all((each.severity, each.path) == ("warning", "root/n0") for each in findings)


def test_what_is_wrong_is_said_with_both_names_and_by_how_much(tmp_path: Path) -> None:
    """Of a place out of reach the distance, of a collision what touches what."""
    far, low = found(
        tmp_path,
        f"motion.MovePose robot: left, target: {{xyz: [1.6, 0, 0.3], {DOWN}}}",
        f"motion.MovePose robot: left, target: {{xyz: [0.5, 0, -0.03], {DOWN}}}",
    )
    assert far.message.startswith("`target`: `left` does not reach it: (1.600, 0.000, 0.300) is out of reach by ")
    assert "left/panda_leftfinger touches table" in low.message


def test_what_a_run_alone_knows_is_not_looked_at(tmp_path: Path) -> None:
    """Data, parameters without default, poses after another tool centre point, entries that the behavior writes."""
    far = f"motion.MovePose robot: left, target: {{xyz: [1.6, 0, 0.3], {DOWN}}}"
    assert len(found(tmp_path, far, "motion.SetToolFrame robot: right")) == 1
    assert found(tmp_path, far, "motion.SetToolFrame robot: left") == ()
    writes = "store.WriteEntry kind: pose, name: far"
    moves = "motion.MovePose robot: left, target: {entry: far}"
    assert found(tmp_path, writes, moves, head="userdata: {value: {}}") == ()
    head = "parameters: {x: {type: number, unit: m, default: 1.6}, y: {type: number, unit: m}}"
    by_default = f"motion.MovePose robot: left, target: {{xyz: ['${{x}}', 0, 0.3], {DOWN}}}"
    open_ = f"motion.MovePose robot: left, target: {{xyz: ['${{y}}', 0, 0.3], {DOWN}}}"
    assert [each.path for each in found(tmp_path, by_default, open_, head=head)] == ["root/n0"]


def test_it_counts_as_what_the_caller_says(tmp_path: Path) -> None:
    """An error, or nothing."""
    far = f"motion.MovePose robot: left, target: {{xyz: [1.6, 0, 0.3], {DOWN}}}"
    assert [each.severity for each in found(tmp_path, far, level="error")] == ["error"]
    assert found(tmp_path, far, level="off") == ()


def test_a_cell_that_cannot_be_built_is_reported_once(tmp_path: Path) -> None:
    """A model that there is not: no arm can be put into it."""
    cell = "flexcell: 1\ncell: bench\nworld: {kind: mujoco}\nrobots: {left: {model: pandra}}\n"
    (tmp_path / "cell.yaml").write_text(cell, encoding="utf-8")
    target = f"motion.MovePose, with: {{robot: left, target: {{xyz: [0.5, 0, 0.3], {DOWN}}}}}"
    states = "\n".join(
        f"      {name}: {{state: {target}, transitions: {{reached: {to}, failed: good}}}}"
        for name, to in (("one", "two"), ("two", "good"))
    )
    head = "flexcell: 1\nname: test\ncell: cell.yaml\noutcomes: [good]\nsuccess: [good]\nroot:\n  machine:\n"
    file = tmp_path / "main.yaml"
    file.write_text(f"{head}    initial: one\n    states:\n{states}\n", encoding="utf-8")
    (finding,) = findings_of(file, CATALOGUE)
    assert (finding.code, finding.severity, finding.position.line) == ("invalid-cell", "error", 3)
    assert "there is no robot model pandra" in finding.message


@pytest.mark.parametrize(
    ("target", "expected"),
    [
        ("{xyz: [0.5, 0, 0.3], xyzw: [0, 0, 0, 0]}", "is not a pose"),
        ("{xyz: [1.0e+300, 0, 0.3], xyzw: [1, 0, 0, 0]}", "out of reach"),
        ("{xyz: [-5.0e+9, 0, 0.3], xyzw: [1, 0, 0, 0]}", "out of reach"),
        # Any length will do, as it does for the arm.
        ("{xyz: [0.5, 0, 0.3], xyzw: [5, 0, 0, 0]}", ""),
    ],
)
def test_numbers_that_are_no_place_end_no_check(tmp_path: Path, target: str, expected: str) -> None:
    """They are reported like a place out of reach."""
    findings = found(tmp_path, f"motion.MovePose robot: left, target: {target}")
    assert [each.code for each in findings] == (["unreachable-target"] if expected else [])
    assert all(expected in each.message for each in findings)


@pytest.mark.parametrize("joints", ["[1.0e+300, 0, 0, -1, 0, 1, 0]", "[0, 0]", "[9, 9, 9, 9, 9, 9, 9]"])
def test_joints_that_the_arm_cannot_have_are_another_finding(tmp_path: Path, joints: str) -> None:
    """`unreachable-joints` has reported them."""
    given = f"with: {{robot: left, target: {joints}}}, transitions: {{reached: good, failed: good}}"
    node = f"      n0: {{state: motion.MoveJoints, {given}}}"
    (tmp_path / "cell.yaml").write_text(CELL, encoding="utf-8")
    (tmp_path / "entries.yaml").write_text(ENTRIES, encoding="utf-8")
    head = "flexcell: 1\nname: test\ncell: cell.yaml\noutcomes: [good]\nsuccess: [good]\nroot:\n  machine:\n"
    file = tmp_path / "main.yaml"
    file.write_text(f"{head}    initial: n0\n    states:\n{node}\n", encoding="utf-8")
    codes = {finding.code for finding in findings_of(file, CATALOGUE)}
    assert codes.isdisjoint({"unreachable-target", "target-in-collision"})
    assert codes


def test_the_cell_and_its_entries_are_read_once_for_all_checks(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Names and targets are looked for in the same documents, whatever is saved meanwhile."""
    looked_at: list[str] = []
    load_text = yaml_source.load_text

    def noted(path: Path) -> bytes:
        # The documents of robot models are read with their first use in a process.
        if path.parent == tmp_path:
            looked_at.append(path.name)
        return load_text(path)

    monkeypatch.setattr(yaml_source, "load_text", noted)
    assert found(tmp_path, f"motion.MovePose robot: left, target: {{xyz: [1.6, 0, 0.3], {DOWN}}}")
    assert sorted(name for name in looked_at if name != "main.yaml") == ["cell.yaml", "entries.yaml"]
