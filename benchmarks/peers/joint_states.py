"""The message that every channel carries in the comparison: the joint state of a seven-axis arm."""

from __future__ import annotations

from engine.messages import JointState

_NAMES = tuple(f"joint{i}" for i in range(1, 8))


def new_joint_state(tick: int) -> JointState:
    """Make the message of a control tick, with values that differ from tick to tick."""
    angle_rad = tick * 1e-3
    values = (angle_rad, -angle_rad, angle_rad, -1.5, angle_rad, 1.5, 0.7)
    return JointState(time_s=tick * 1e-3, names=_NAMES, position_rad=values, velocity_rad_s=values, effort_nm=values)
