"""Plays the datagrams of a controller with Externally Guided Motion back to the driver, in their time."""

from __future__ import annotations

import asyncio
import logging
import socket
from collections.abc import Mapping, Sequence
from contextlib import suppress
from types import TracebackType
from typing import Self

from robots.drivers.abb.abb_faults import AbbLinkError
from robots.drivers.abb.egm.egm_messages import decode_set_point, renumber_measurement
from robots.drivers.abb.egm.egm_options import PERIOD_S
from robots.io.wire.datagram_socket import DatagramSocket
from robots.io.wire.read_capture import CapturedConnection, CapturedEvent
from robots.io.wire.wire_tap import NO_TAP, Address

_MOST_BYTES = 4096
_KNOCK_S = 0.02
_log = logging.getLogger("flexcell.devices")


class EgmReplay:
    """The controller's side of captured guided motion.

    The first measurement is sent until somebody listens, the others follow at their recorded times. Where the driver
    answered for the first time, the last one before is repeated until it does so again, and all numbers and times after
    it are later. Any set points are taken, as they depend on time.

    Args:
        captured: The datagrams of a driver.
        host: IPv4 address to send from: the driver's `host`.
        receiver: IPv4 address to send to, at the recorded port.
        pace: Share of the recorded delays.
    """

    def __init__(self, captured: CapturedConnection, *, host: str, receiver: str, pace: float) -> None:
        self._host = host
        self._pace = pace
        self._measurements, self._before_answers, port = _of_controller(captured.events)
        self._later = 0
        self._client: Address = (receiver, port)
        self._sent = self._heard = 0
        self._mismatch = ""
        self._playing: asyncio.Task[None] | None = None
        self.ports: list[int] = []
        """Where it receives."""

    def __enter__(self) -> Self:
        self._socket = DatagramSocket(NO_TAP)
        self._socket.bind((self._host, 0))
        self._socket.never_wait()
        self.ports = [self._socket.port]
        loop = asyncio.get_running_loop()
        loop.add_reader(self._socket.fileno(), self._take)
        self._playing = loop.create_task(self._play(), name="replay of EGM")
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        asyncio.get_running_loop().remove_reader(self._socket.fileno())
        if self._playing is not None:
            self._playing.cancel()
        self._socket.close()

    def state(self) -> Mapping[str, object]:
        """Return what was replayed, and what is left."""
        return {
            "mismatch": self._mismatch,
            "answered": self._heard,
            "remaining_commands": 0,
            "remaining_measurements": len(self._measurements) - self._sent,
        }

    async def _play(self) -> None:
        if not self._measurements:
            return
        loop = asyncio.get_running_loop()
        while not await self._listens(self._measurements[0].data):
            pass
        self._sent, begun_s = 1, loop.time()
        first_s = self._measurements[0].time_s
        for event in self._measurements[1:]:
            if self._sent == self._before_answers:
                held_s = loop.time()
                await self._hold(self._measurements[self._sent - 1].data)
                begun_s += loop.time() - held_s
            await asyncio.sleep(max(0.0, begun_s + self._pace * (event.time_s - first_s) - loop.time()))
            self._send(event.data)
            self._sent += 1

    async def _hold(self, datagram: bytes) -> None:
        """Repeat a measurement until the driver answers."""
        while not self._heard:
            await asyncio.sleep(PERIOD_S)
            self._later += 1
            self._send(datagram)

    def _send(self, datagram: bytes) -> None:
        with suppress(AbbLinkError):  # garbage has no number
            datagram = renumber_measurement(datagram, by=self._later, time_ms=round(self._later * PERIOD_S * 1e3))
        # Nobody may listen any more: the controller sends on.
        with suppress(BlockingIOError, ConnectionRefusedError):
            self._socket.send(datagram, self._client)

    async def _listens(self, datagram: bytes) -> bool:
        """Send the first measurement, and return whether it was not refused."""
        with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as knocking:
            knocking.bind((self._host, 0))
            knocking.setblocking(False)
            try:
                knocking.connect(self._client)
                knocking.send(datagram)
                await asyncio.sleep(_KNOCK_S)
                knocking.recv(_MOST_BYTES)
            except BlockingIOError:
                return True
            except ConnectionRefusedError:
                return False
        return True

    def _take(self) -> None:
        try:
            data = self._socket.receive(_MOST_BYTES)
            decode_set_point(data)
        except (BlockingIOError, ConnectionRefusedError):
            return
        except AbbLinkError as error:
            if not self._mismatch:
                self._mismatch = str(error)
                _log.warning("the driver does not do what was recorded: %s", error)
            return
        self._heard += 1


def _of_controller(events: Sequence[CapturedEvent]) -> tuple[list[CapturedEvent], int, int]:
    """Return what the controller sent, how much of it before the first answer, and to which port it sent.

    Others may have sent to the port too. Without answers all of it was before.
    """
    kept = [(each, each.endpoints) for each in events if each.endpoints is not None]
    answers = [number for number, (each, _) in enumerate(kept) if each.kind == "sent"]
    if not kept:
        return [], 0, 0
    ends = kept[answers[0] if answers else 0][1]
    before = len(kept) if not answers else answers[0]
    mine = [
        number for number, (each, its) in enumerate(kept) if each.kind != "sent" and its.remote[0] == ends.remote[0]
    ]
    return [kept[number][0] for number in mine], sum(number < before for number in mine), ends.local[1]
