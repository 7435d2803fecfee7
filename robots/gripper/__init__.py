"""Skill servers of the tools at an arm's flange: grippers, hands and others over their ports, simulated or real."""

from robots.gripper.gripper_server import GripperServer
from robots.gripper.hand_server import HandServer
from robots.gripper.tool_server import ToolServer

__all__ = ["GripperServer", "HandServer", "ToolServer"]
