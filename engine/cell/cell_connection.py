"""The connection of a cell's devices: published on `cell/connection`, required by runs, restored by command."""

from __future__ import annotations

import asyncio
import logging

from engine.bus import SkillBus
from engine.errors import CONNECT_AGAIN, RobotError
from engine.messages import Message
from engine.robot import Reconnectable, Robot

_log = logging.getLogger("flexcell.cell")


class CellConnection(Message, frozen=True, kw_only=True):
    """Whether every device of the cell is connected; the latest value of `cell/connection`.

    `reason` names the lost devices with the causes; for a reconnected cell, the differences from before.
    """

    connected: bool
    reason: str = ""


class CellConnectionMonitor:
    """Monitors the devices of one open cell that can lose their connection."""

    def __init__(self, bus: SkillBus) -> None:
        self._bus = bus
        self._devices: list[Reconnectable] = []
        self._notes: tuple[str, ...] = ()
        self._lock = asyncio.Lock()

    @property
    def now(self) -> CellConnection:
        """The present connection."""
        lost = [device.lost_reason for device in self._devices if device.lost_reason]
        return CellConnection(connected=not lost, reason="; ".join(lost or self._notes))

    def follow(self, device: Robot | Reconnectable) -> None:
        """Publish the loss and reconnection of `device`; does nothing for a device that is not reconnectable."""
        if isinstance(device, Reconnectable):
            self._devices.append(device)
            device.when_connection_changes(self._publish)
            self._publish()

    def require(self) -> None:
        """Raise RobotError while a device is not connected."""
        now = self.now
        if not now.connected:
            raise RobotError(now.reason, where="cell", hint=CONNECT_AGAIN)

    async def reconnect(self) -> None:
        """Reconnect all lost devices; does nothing when all are connected.

        Raises:
            RobotError: a device cannot be reconnected.
        """
        async with self._lock:
            notes = [await device.reconnect() for device in self._devices if device.lost_reason]
            if notes:
                self._notes = tuple(note for note in notes if note)
                self._publish()

    def _publish(self) -> None:
        now, topic = self.now, self._bus.topic("cell/connection", CellConnection)
        if now == topic.latest:
            return
        if topic.latest is not None:
            _log.log(logging.INFO if now.connected else logging.ERROR, "%s", now.reason or "the cell is connected")
        topic.publish(now)
