"""The motion link never has the event loop wait for its thread."""

from __future__ import annotations

import asyncio
import threading

import pytest

from robots.drivers.abb import motion_link
from robots.drivers.abb.motion_link import MotionLink

_MORE_THAN_A_SOCKET_KEEPS = 10_000


class Listener:
    """Hears nothing of interest."""

    def motion_link_lost(self, reason: str) -> None:
        """Nothing is connected."""

    def stopped_by_silence(self, silent_s: float) -> None:
        """Nothing is armed."""


def test_a_thread_that_is_connecting_is_asked_without_waiting_for_it(monkeypatch: pytest.MonkeyPatch) -> None:
    """A controller whose motion port is cut lets it wait for the whole time limit."""
    begun, released = threading.Event(), threading.Event()

    def connected_never(*_: object) -> object:
        begun.set()
        released.wait(60.0)
        raise motion_link.AbbLinkError(motion_link.AbbFault.LINK_CUT, "cannot connect")

    async def asked() -> bool:
        link = MotionLink("127.0.0.1", 1, Listener(), byte_order="little", timeout_s=1.0, silence_s=9.0)
        try:
            connecting = link.connect()
            await asyncio.to_thread(begun.wait, 60.0)
            for _ in range(_MORE_THAN_A_SOCKET_KEEPS):
                link.arm(armed=False)
            was_waiting = not connecting.done()
            released.set()
            await asyncio.wait((connecting,))
            assert connecting.exception() is not None
            return was_waiting
        finally:
            released.set()
            await link.close()

    monkeypatch.setattr(motion_link, "connected", connected_never)
    assert asyncio.run(asked())
