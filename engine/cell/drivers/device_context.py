"""What the maker of a device may need to know of the cell, besides the options of the driver."""

from __future__ import annotations

import socket
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from pathlib import Path

from engine.document import Cell
from engine.robot import Robot, World


@dataclass(frozen=True, kw_only=True)
class DeviceContext:
    """The surroundings of one device with a driver.

    Attributes:
        cell: The document of the cell.
        robot: Name in it of the arm, of the arm that has the tool, or of the equipment.
        world: The open simulated world in which its body is mirrored; None without one.
        devices: Devices of the cell by name, those that are opened already; more of them come.
        new_stop_line: Makes the line on which the arm's process receives STOP; None without one.
        capture: Folder to which the bytes of the device's connections are captured; None for none.
    """

    cell: Cell
    robot: str
    world: World | None = None
    devices: Mapping[str, Robot] = field(default_factory=dict[str, Robot])
    new_stop_line: Callable[[str], socket.socket] | None = None
    capture: Path | None = None
