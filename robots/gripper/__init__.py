"""Skill servers of the tools at an arm's flange: grippers, hands and magnets over their ports, simulated or real."""

from robots.gripper.grasp_check import GraspCommand, check_grasp
from robots.gripper.gripper_server import GripperServer
from robots.gripper.hand_grasp_check import HandGrasp, check_hand_grasp
from robots.gripper.hand_server import HandServer
from robots.gripper.magnet_server import MagnetServer, check_magnet_grasp
from robots.gripper.tool_server import ToolServer

__all__ = [
    "GraspCommand",
    "GripperServer",
    "HandGrasp",
    "HandServer",
    "MagnetServer",
    "ToolServer",
    "check_grasp",
    "check_hand_grasp",
    "check_magnet_grasp",
]
