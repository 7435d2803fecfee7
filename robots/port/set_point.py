"""The set point of an arm as the bus carries it."""

from __future__ import annotations

import numpy as np

from engine.messages import JointSetPoint
from robots.port.arm import ArmSample


def to_set_point(sample: ArmSample, joints: tuple[str, ...]) -> JointSetPoint:
    """Return the set point of a sample with the largest deviation of a measured joint."""
    deviation_rad = float(np.abs(sample.desired_rad - sample.position_rad).max(initial=0.0))
    return JointSetPoint(
        time_s=sample.time_s,
        names=joints,
        position_rad=tuple(sample.desired_rad.tolist()),
        deviation_rad=deviation_rad,
    )
