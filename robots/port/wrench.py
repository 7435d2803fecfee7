"""The measured wrench on the tool as a message."""

from __future__ import annotations

from engine.messages import Wrench
from robots.port import Array


def to_wrench(wrench: Array) -> Wrench:
    """Return force (N) and torque (N m) of the environment on the tool, (6,), in world axes."""
    fx, fy, fz, tx, ty, tz = wrench.tolist()
    return Wrench(force_n=(fx, fy, fz), torque_nm=(tx, ty, tz), frame="world")
