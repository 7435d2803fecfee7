"""Skill servers of the tools at an arm's flange: grippers, hands and magnets over their ports, simulated or real."""

from robots.gripper.gripper_server import GripperServer
from robots.gripper.hand_server import HandServer
from robots.gripper.magnet_server import MagnetServer
from robots.gripper.tool_server import ToolServer

__all__ = ["GripperServer", "HandServer", "MagnetServer", "ToolServer"]
