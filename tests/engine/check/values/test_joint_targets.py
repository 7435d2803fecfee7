"""Joint angles that stand in a behavior are compared with the joints of the arm in the cell."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.engine.check.checking import findings_in_files

CELL = """
flexcell: 1
cell: bench
world: {kind: mujoco}
robots:
  left: {model: panda}
  small: {model: servo_arm}
"""


@pytest.mark.parametrize(
    ("robot", "target", "finding"),
    [
        ("left", "[0, -0.8, 0, -2.4, 0, 1.6, 0.8]", ""),
        ("small", "[0.1, '${angle}']", ""),
        ("small", "{entry: home}", ""),
        ("elsewhere", "[0, 0]", ""),
        ("left", "[0, -0.8]", "`target`: `left` has 7 joints, not 2 (write one angle in radians for each joint)"),
        ("'${arm}'", "[0]", "`target`: `small` has 2 joints, not 1 (write one angle in radians for each joint)"),
        (
            "left",
            "[0, -0.8, 0, 0.5, 0, 1.6, 0.8]",
            "`target`: joint 4 of `left`: 0.5 rad is outside the joint limits (the limits are -3.072 to -0.0698 rad)",
        ),
        ("left", "[0, -45, 0, -137, 0, 90, 45]", ""),
    ],
)
def test_angles_that_the_arm_cannot_have_are_reported(tmp_path: Path, robot: str, target: str, finding: str) -> None:
    """Their number, and the first one beyond its limits; degrees are another finding."""
    main = f"""
    cell: cell.yaml
    parameters:
      arm: {{type: string, default: small}}
      angle: {{type: number, default: 0, unit: rad}}
    root:
      machine:
        initial: it
        states:
          it:
            state: motion.MoveJoints
            with: {{robot: {robot}, target: {target}}}
            transitions: {{reached: good, failed: bad}}
    """
    found = findings_in_files(tmp_path, main=main, cell=CELL)
    reported = [f"{each.message} ({each.hint})" for each in found if each.code == "unreachable-joints"]
    assert reported == ([finding] if finding else [])


def test_the_waypoint_with_the_wrong_angle_is_named_at_its_place(tmp_path: Path) -> None:
    """By its index, at the line of the angle; so is a waypoint that is none."""
    main = """
    cell: cell.yaml
    root:
      machine:
        initial: it
        states:
          it:
            state: motion.FollowWaypoints
            with:
              robot: small
              waypoints:
                - {joints: [0.1, 0.2], blend_m: 0.01}
                - joints: {entry: home}
                - joints: [0.1, 3.0]
                - {joints: ['${angle}', 0.1]}
            transitions: {reached: good, failed: bad}
    parameters: {angle: {type: number, default: 0, unit: rad}}
    """
    (found,) = [each for each in findings_in_files(tmp_path, main=main, cell=CELL) if each.code == "unreachable-joints"]
    assert found.message.startswith("`waypoints[2].joints`: joint 2 of `small`: 3 rad is outside")
    assert found.position is not None
    line = (tmp_path / "main.yaml").read_text(encoding="utf-8").splitlines()[found.position.line - 1]
    assert "joints: [0.1, 3.0]" in line


@pytest.mark.parametrize(
    ("waypoints", "message"),
    [
        ("[]", "expected list of length >= 1"),
        ("[{blend_m: 0.1}]", "give either `joints` or `pose`"),
        ("[{joints: [0.1, 0.2], blend_m: -1}]", "expected number >= 0.0"),
        ("[{joints: [0.1, 0.2], pose: {xyz: [0, 0, 1]}}]", "give either `joints` or `pose`"),
        ("[{pose: {entry: home, xyz: [0, 0, 1]}}]", "give either `entry` or `xyz`"),
        ("[[0.1, 0.2]]", "expected mapping, got list"),
    ],
)
def test_waypoints_that_are_none_are_reported(tmp_path: Path, waypoints: str, message: str) -> None:
    """Before anything moves."""
    main = f"""
    cell: cell.yaml
    root:
      machine:
        initial: it
        states:
          it:
            state: motion.FollowWaypoints
            with: {{robot: small, waypoints: {waypoints}}}
            transitions: {{reached: good, failed: bad}}
    """
    findings = [each for each in findings_in_files(tmp_path, main=main, cell=CELL) if each.severity == "error"]
    assert [each.code for each in findings] == ["bad-parameter"]
    assert message in findings[0].message
