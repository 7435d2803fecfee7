"""A control loop in miniature: a thread that polls its stop line and rests as soon as it is told to stop."""

from __future__ import annotations

import asyncio
import json
import threading
from collections.abc import AsyncGenerator
from contextlib import asynccontextmanager

import httpx

from engine.stop import StopEndpoint, StopLine, StopRelay


class Device:
    """The device `world` of a relay; `stops` are the reasons of the stops that it has taken."""

    def __init__(self, relay: StopRelay) -> None:
        self.connection = relay.new_line("world")
        self.line = StopLine(self.connection)
        self.stops: list[str] = []
        self.rests = True
        self.stopped = threading.Event()
        self.released = threading.Event()
        self._end = threading.Event()
        self._thread = threading.Thread(target=self._run)
        self._thread.start()

    def _run(self) -> None:
        while not self._end.wait(0.001):
            if reason := self.line.poll():
                self.stops.append(reason)
                self.stopped.set()
            if self.stops and not self.line.latched:
                self.released.set()
            if self.rests:
                self.line.report_at_rest()

    def close(self) -> None:
        """End the loop and cut the line."""
        self._end.set()
        self._thread.join()
        self.connection.close()


@asynccontextmanager
async def device(relay: StopRelay) -> AsyncGenerator[Device]:
    """Return a device that is there while the block runs."""
    made = Device(relay)
    try:
        yield made
    finally:
        made.close()


def endpoint_of(relay: StopRelay) -> StopEndpoint:
    """Return where a relay takes STOP."""
    assert relay.endpoint is not None
    return relay.endpoint


def post(endpoint: StopEndpoint, *, path: str = "", token: str | None = None, reason: str = "test") -> httpx.Response:
    """Ask for STOP, waiting for the answer."""
    body = {"token": endpoint.token if token is None else token, "reason": reason}
    return httpx.post(endpoint.url + path, content=json.dumps(body), timeout=10, trust_env=False)


async def posted(endpoint: StopEndpoint, **options: str) -> httpx.Response:
    """Ask for STOP on another thread, so that the loop goes on."""
    return await asyncio.to_thread(lambda: post(endpoint, **options))
