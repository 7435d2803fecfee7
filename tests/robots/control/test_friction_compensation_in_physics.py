"""Arms whose friction is compensated end where they should, and are reported there at once."""

from __future__ import annotations

import pytest

from benchmarks.doubt_motions import IRB4600, PANDA, ends
from benchmarks.first_touch import Subject


@pytest.mark.parametrize(("subject", "behind_m"), [(PANDA, 0.0003), (IRB4600, 0.0006)], ids=["panda", "irb4600"])
def test_a_typical_arm_is_in_position_when_its_motion_is_reached_and_does_not_wait(
    subject: Subject, behind_m: float
) -> None:
    """With friction that was compensated no more below 0.02 rad/s they were up to 0.6 and 0.9 mm behind."""
    behinds_m, waited_s = ends(subject, "joint_impedance", "typical")
    assert max(behinds_m) < behind_m
    assert sum(waited_s) < 0.05 * len(waited_s)


def test_without_friction_no_motion_takes_longer() -> None:
    behinds_m, waited_s = ends(IRB4600, "joint_impedance", "ideal")
    assert max(behinds_m) < 0.0003
    assert max(waited_s) < 0.005
