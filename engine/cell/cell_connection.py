"""Which devices of a cell are connected: told on `cell/connection`, required by runs, restored by command."""

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

    `reason` says which is lost and why; of a connected cell what is not as it was before it was connected again.
    """

    connected: bool
    reason: str = ""


class CellConnectionMonitor:
    """Follows the devices of one open cell that can lose their connection."""

    def __init__(self, bus: SkillBus) -> None:
        self._bus = bus
        self._devices: list[Reconnectable] = []
        self._notes: tuple[str, ...] = ()
        self._turn = asyncio.Lock()

    @property
    def now(self) -> CellConnection:
        """What is connected now."""
        lost = [device.lost_reason for device in self._devices if device.lost_reason]
        return CellConnection(connected=not lost, reason="; ".join(lost or self._notes))

    def follow(self, device: Robot | Reconnectable) -> None:
        """Tell from now on when `device` is lost and when it is back; nothing for one that cannot be."""
        if isinstance(device, Reconnectable):
            self._devices.append(device)
            device.when_connection_changes(self._tell)
            self._tell()

    def require(self) -> None:
        """Raise RobotError while a device is lost."""
        now = self.now
        if not now.connected:
            raise RobotError(now.reason, where="cell", hint=CONNECT_AGAIN)

    async def reconnect(self) -> None:
        """Connect again what is lost; does nothing where nothing is.

        Raises:
            RobotError: a device does not come back.
        """
        async with self._turn:
            notes = [await device.reconnect() for device in self._devices if device.lost_reason]
            if notes:
                self._notes = tuple(note for note in notes if note)
                self._tell()

    def _tell(self) -> None:
        now, topic = self.now, self._bus.topic("cell/connection", CellConnection)
        if now == topic.latest:
            return
        if topic.latest is not None:
            _log.log(logging.INFO if now.connected else logging.ERROR, "%s", now.reason or "the cell is connected")
        topic.publish(now)
