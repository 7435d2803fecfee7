"""A running test server and how to talk to it."""

from __future__ import annotations

import json
from collections.abc import AsyncGenerator
from contextlib import asynccontextmanager
from dataclasses import dataclass
from typing import Any

import httpx
import websockets.asyncio.client

from editor_web.security.authentication import OPERATOR, AccessTokens, Role
from editor_web.security.middleware import cookie_name
from editor_web.server import Dashboard
from tests.editor_web.fake_backend import FakeBackend


def session_cookie(running: Dashboard, role: Role = OPERATOR) -> dict[str, str]:
    """Headers of a browser that has just logged in, without an origin."""
    return {"Cookie": f"{cookie_name(running.port)}={running.sessions.begin(role)}"}


@dataclass(frozen=True, kw_only=True)
class Served:
    """The server, the fake engine behind it, and a client with the operator's token."""

    backend: FakeBackend
    running: Dashboard
    access: AccessTokens
    http: httpx.AsyncClient

    @property
    def origin(self) -> str:
        """Origin of the page."""
        return self.running.url.rstrip("/")

    @property
    def cookie(self) -> dict[str, str]:
        """Headers of an operator's browser without an origin."""
        return session_cookie(self.running)

    @asynccontextmanager
    async def live(self, run: str | None = None) -> AsyncGenerator[Live]:
        """Open the live stream, as the page does, and watch a run."""
        async with websockets.asyncio.client.connect(
            f"{self.origin.replace('http', 'ws', 1)}/api/v1/live",
            additional_headers=self.cookie,
            origin=websockets.Origin(self.origin),
            compression=None,
            proxy=None,
        ) as socket:
            live = Live(socket)
            if run is not None:
                await live.send({"k": "watch", "run": run})
            yield live


class Live:
    """The client's end of a live stream."""

    def __init__(self, socket: websockets.asyncio.client.ClientConnection) -> None:
        self.socket = socket

    async def send(self, message: dict[str, object]) -> None:
        """Send one message."""
        await self.socket.send(json.dumps(message))

    async def frame(self) -> dict[str, Any]:
        """Receive one frame."""
        return json.loads(await self.socket.recv())

    async def until(self, kind: str, **fields: object) -> dict[str, Any]:
        """Receive frames up to one of this kind and these values."""
        while True:
            frame = await self.frame()
            if frame["k"] == kind and all(frame[name] == value for name, value in fields.items()):
                return frame
