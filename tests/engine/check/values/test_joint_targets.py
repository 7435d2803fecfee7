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
