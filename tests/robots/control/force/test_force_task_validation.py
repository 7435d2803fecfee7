"""Force tasks that make no sense are refused with the reason."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from engine.errors import RobotError
from engine.skills.dmp import Compliance
from robots.control.force.force_task_validation import validate_force_task
from robots.port import ForceTask, JointTrajectory

JOINTS = ("shoulder", "elbow")
GOOD = ForceTask(
    trajectory=JointTrajectory(dt_s=0.1, position_rad=np.zeros((5, 2)), velocity_rad_s=np.zeros((5, 2))),
    offset=np.zeros((5, 6)),
    wrench=np.zeros((5, 6)),
)


def test_a_sensible_task_is_passed_on() -> None:
    assert validate_force_task(GOOD, start_rad=np.zeros(2), joints=JOINTS) is GOOD


@pytest.mark.parametrize(
    ("task", "message"),
    [
        (replace(GOOD, offset=np.zeros((4, 6))), r"the offset has shape \(4, 6\)"),
        (replace(GOOD, wrench=np.full((5, 6), np.nan)), "the wrench has .* not finite"),
        (replace(GOOD, offset=np.full((5, 6), 0.06)), "the offset of 0.0600 along axis 0 exceeds the reach of 0.05"),
        (replace(GOOD, record_s=0.0), "record_s must be positive"),
        (replace(GOOD, slow_per_n=-1.0), "slow_per_n"),
        (replace(GOOD, task_xyzw=(0.0, 0.0, 0.0, 2.0)), "is not a unit quaternion"),
        (
            replace(GOOD, admittance=Compliance(stiffness=(0.0, 0.0, math.inf, 0.0, 0.0, 0.0))),
            "not finite on axis 2",
        ),
        (replace(GOOD, admittance=Compliance(reach_m=0.0)), "must be positive"),
    ],
)
def test_what_makes_no_sense_is_refused(task: ForceTask, message: str) -> None:
    with pytest.raises(RobotError, match=message):
        validate_force_task(task, start_rad=np.zeros(2), joints=JOINTS)


def test_a_path_that_starts_elsewhere_is_refused() -> None:
    with pytest.raises(RobotError, match="from the set point of elbow"):
        validate_force_task(GOOD, start_rad=np.array([0.0, 0.2]), joints=JOINTS)
