"""One two-finger gripper on the bus: open, move and grasp over a `GripperPort`, simulated or real."""

from robots.gripper.grip_judgement import Grip, judge
from robots.gripper.gripper_server import GripperServer

__all__ = ["Grip", "GripperServer", "judge"]
