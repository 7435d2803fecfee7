"""The tools at the flange of an arm on the bus: grippers, hands and magnets over their ports, simulated or real."""

from robots.gripper.grip_judgement import Grip, judge
from robots.gripper.gripper_server import GripperServer
from robots.gripper.hand_judgement import Holding, judge_hand
from robots.gripper.hand_server import HandServer
from robots.gripper.magnet_server import MagnetServer, judge_magnet
from robots.gripper.tool_server import ToolServer

__all__ = [
    "Grip",
    "GripperServer",
    "HandServer",
    "Holding",
    "MagnetServer",
    "ToolServer",
    "judge",
    "judge_hand",
    "judge_magnet",
]
