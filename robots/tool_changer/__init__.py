"""Tool changers of arms: lock, release, what the sensors tell, and what the arm has with a tool, over a port."""

from robots.tool_changer.changeable_tools import changeable_tools
from robots.tool_changer.tool_changer_server import ToolChangerServer
from robots.tool_changer.tool_lock_port import LockReading, ToolLockPort

__all__ = ["LockReading", "ToolChangerServer", "ToolLockPort", "changeable_tools"]
