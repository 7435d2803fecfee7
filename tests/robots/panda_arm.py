"""The Panda as tests of kinematics and motion use it: model, kinematics at a base, and random ways."""

from __future__ import annotations

import functools

import numpy as np
from hypothesis import strategies as st

from robots.model import RobotModel, model_by_name
from robots.model.mechanics.kinematics import ArmKinematics
from robots.model.transform import RigidTransform
from robots.port import Array, JointTrajectory

BASE = RigidTransform.of((-0.55, 0.0, 0.0), (0.0, 0.0, 0.0, 1.0))


@functools.cache
def panda_model() -> RobotModel:
    """The model, read once."""
    return model_by_name("panda")


@functools.cache
def panda_kinematics() -> ArmKinematics:
    """The arm at `BASE`."""
    return ArmKinematics(panda_model(), base=BASE)


def home() -> Array:
    """The resting configuration."""
    return np.array(panda_model().home_rad)


def configurations(margin_rad: float = 0.0) -> st.SearchStrategy[Array]:
    """Joint configurations within the limits, `margin_rad` off them."""
    limits = panda_model().limits
    joints = [
        st.floats(lower + margin_rad, upper - margin_rad)
        for lower, upper in zip(limits.lower_rad, limits.upper_rad, strict=True)
    ]
    return st.tuples(*joints).map(np.array)


def played(trajectory: JointTrajectory, *, between: int = 7) -> tuple[Array, Array, Array]:
    """Return position, velocity, acceleration as a port interpolates them: cubic Hermite between samples."""
    h = trajectory.dt_s
    p0, p1 = trajectory.position_rad[:-1, None, :], trajectory.position_rad[1:, None, :]
    v0, v1 = trajectory.velocity_rad_s[:-1, None, :], trajectory.velocity_rad_s[1:, None, :]
    u = np.linspace(0.0, 1.0, between)[None, :, None]
    rise = (p1 - p0) / h
    position = (
        (1 - 3 * u**2 + 2 * u**3) * p0
        + (3 * u**2 - 2 * u**3) * p1
        + h * ((u - 2 * u**2 + u**3) * v0 + (u**3 - u**2) * v1)
    )
    velocity = (6 * u - 6 * u**2) * rise + (1 - 4 * u + 3 * u**2) * v0 + (3 * u**2 - 2 * u) * v1
    acceleration = ((6 - 12 * u) * rise + (6 * u - 4) * v0 + (6 * u - 2) * v1) / h
    joints = trajectory.position_rad.shape[1]
    return position.reshape(-1, joints), velocity.reshape(-1, joints), acceleration.reshape(-1, joints)
