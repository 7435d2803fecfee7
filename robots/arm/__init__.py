"""One robot arm on the bus: motion skills over an `ArmPort`, simulated or real."""

from robots.arm.arm_server import ArmServer
from robots.arm.execution.arm_planner import ArmPlanner
from robots.arm.execution.tool_frames import ToolFrames

__all__ = ["ArmPlanner", "ArmServer", "ToolFrames"]
