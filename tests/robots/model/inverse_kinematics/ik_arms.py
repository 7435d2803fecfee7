"""The arms that tests of inverse kinematics ask, each made once, at a base that is turned and shifted."""

from __future__ import annotations

import functools
import tempfile
from pathlib import Path

import numpy as np
from hypothesis import strategies as st

from benchmarks.ik_arms import BASE, CALIBRATION, calibrated_ur10
from robots.model.mechanics.kinematics import ArmKinematics
from robots.model.registry import robot_model
from robots.model.robot_model import RobotModel
from robots.port import Array

SIX_AXES = ("ur10", "ur10 of the lab", "ur10 calibrated", "irb4600")
ARMS = ("panda", *SIX_AXES)
"""`ur10 of the lab` has the calibration file of the source document, `ur10 calibrated` one of a usual size."""


def _model(name: str) -> RobotModel:
    if name == "ur10 of the lab":
        return robot_model("ur10", calibration=CALIBRATION)
    if name == "ur10 calibrated":
        with tempfile.TemporaryDirectory() as folder:
            return calibrated_ur10(Path(folder), size=1e-3)
    return robot_model(name)


@functools.cache
def arm(name: str) -> ArmKinematics:
    """Return the kinematics of an arm of `ARMS`, or of any model."""
    return ArmKinematics(_model(name), base=BASE)


def limits(kinematics: ArmKinematics) -> tuple[Array, Array]:
    """Return the lower and the upper joint limits."""
    return np.array(kinematics.limits.lower_rad), np.array(kinematics.limits.upper_rad)


def shares() -> st.SearchStrategy[Array]:
    """Return seven shares of joint ranges, 0 to 1; shorter arms take the first of them."""
    return st.lists(st.floats(0.0, 1.0), min_size=7, max_size=7).map(np.array)


def at_shares(kinematics: ArmKinematics, share: Array) -> Array:
    """Return the configuration at these shares of the joints' ranges."""
    lower, upper = limits(kinematics)
    return lower + share[: len(lower)] * (upper - lower)
