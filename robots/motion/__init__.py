"""Planned motions of one arm: joint profiles and straight lines, as trajectories for an `ArmPort`."""

from robots.motion.cart_line import plan_line
from robots.motion.joint_profile import plan_joints

__all__ = ["plan_joints", "plan_line"]
