"""The contract between the driver of switched tools and a kind of tool."""

from __future__ import annotations

from typing import Protocol

from engine.messages import Message
from robots.gripper.tool_server import ToolServer
from robots.switched.switched_drive import SwitchedDrive


class SwitchedServer(ToolServer, Protocol):
    """The skills of one switched tool."""

    def state(self) -> Message:
        """Return its state, the message of `<arm>/<kind of tool>/state`; raises RobotError where it is not known."""
        ...


class SwitchedKind(Protocol):
    """What a kind of tool is when outputs switch it."""

    def server(self, name: str, drive: SwitchedDrive) -> SwitchedServer:
        """Return the server of a tool under its bus name."""
        ...
