"""Numbers that seem to be degrees or millimetres are reported, with what they would be in the unit that is due."""

from __future__ import annotations

import pytest

from tests.engine.check.checking import findings_in

MACHINE = """
%s
root:
  machine:
    initial: it
    states:
      it: {state: %s, with: {%s}, transitions: {reached: good, failed: bad}}
"""


@pytest.mark.parametrize(
    ("state", "given", "message", "hint"),
    [
        (
            "motion.MoveJoints",
            "robot: left, target: [0, -45, 0, -90, 0, 90, 45]",
            "`target`: -90 rad looks like degrees",
            "if so, write [0, -0.7854, 0, -1.5708, 0, 1.5708, 0.7854]",
        ),
        (
            "motion.MovePose",
            "robot: left, target: {xyz: [400, 0, 300]}",
            "`xyz`: 400 m looks like millimetres",
            "if so, write [0.4, 0, 0.3]",
        ),
        ("gripper.Move", "gripper: left, width_m: 40", "`width_m`: 40 m looks like millimetres", "if so, write 0.04"),
        (
            "gripper.Move",
            "gripper: left, width_m: 0.04, speed_m_s: 100",
            "`speed_m_s`: 100 m/s looks like millimetres per second",
            "if so, write 0.1",
        ),
    ],
)
def test_a_number_that_is_too_large_for_its_unit_is_reported(state: str, given: str, message: str, hint: str) -> None:
    """Once for a list, with the whole list as it may be meant."""
    (found,) = findings_in(MACHINE % ("", state, given))
    assert (found.code, found.message, found.hint) == ("suspect-unit", message, hint)


@pytest.mark.parametrize(
    "given",
    [
        "robot: left, target: [6.9, -6.28, 0, -2.3, 0, 1.5, 0.7]",
        "robot: left, target: {entry: home}",
        "robot: left, target: ['${angle}', 0]",
    ],
)
def test_what_an_arm_can_do_is_not_reported(given: str) -> None:
    """Some joints turn more than once around."""
    head = "parameters: {angle: {type: number, default: 1, unit: rad}}"
    assert findings_in(MACHINE % (head if "angle" in given else "", "motion.MoveJoints", given)) == ()


def test_the_default_of_a_parameter_is_looked_at_by_its_unit() -> None:
    """At the default, not at each use."""
    head = "parameters: {width: {type: number, default: 40, unit: m}}"
    (found,) = findings_in(MACHINE % (head, "gripper.Move", "gripper: left, width_m: '${width}'"))
    assert (found.message, found.position.line) == ("`width`: 40 m looks like millimetres", 6)
