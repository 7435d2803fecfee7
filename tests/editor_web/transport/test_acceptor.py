"""Connections are bounded, the longest waiting makes room, and a process without descriptors stays calm."""

from __future__ import annotations

import asyncio
import errno
import socket
from contextlib import suppress
from pathlib import Path
from typing import Any

import httpx
import pytest

from editor_web.security.authentication import load_access_tokens
from editor_web.server import Dashboard, dashboard
from tests.editor_web.fake_backend import FakeBackend
from tests.editor_web.limits import GUARD_S

LIMIT = 12


async def connected(running: Dashboard) -> socket.socket:
    """A connection that says nothing."""
    wire = socket.socket()
    wire.setblocking(False)
    host = running.url.removeprefix("http://").split(":")[0]
    await asyncio.get_running_loop().sock_connect(wire, (host, running.port))
    return wire


async def session_status(running: Dashboard, token: str) -> int:
    """Ask as the command line does, on a connection of its own."""
    headers = {"Authorization": f"Bearer {token}"}
    async with httpx.AsyncClient(trust_env=False, timeout=GUARD_S, headers=headers) as client:
        return (await client.get(f"{running.url}api/v1/session")).status_code


async def test_who_only_waits_makes_room(tmp_path: Path, loopback: str) -> None:
    """Many times as many connections as there may be: all those with something to say are served."""
    token_file = tmp_path / "tokens"
    async with dashboard(
        FakeBackend(), token_file=token_file, host=loopback, cell_view=False, max_connections=LIMIT
    ) as running:
        token = load_access_tokens(token_file).operator
        silent = [await connected(running) for _ in range(5 * LIMIT)]
        assert await session_status(running, token) == 200
        loop = asyncio.get_running_loop()
        async with asyncio.timeout(GUARD_S):
            # The first ones were closed: they read the end.
            for wire in silent[:LIMIT]:
                with suppress(ConnectionResetError):
                    assert await loop.sock_recv(wire, 1) == b""
        for wire in silent:
            wire.close()


async def test_without_descriptors_it_waits_says_so_once_and_goes_on(
    tmp_path: Path, loopback: str, monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture
) -> None:
    """asyncio's own server logs thousands of errors a second then."""
    loop = asyncio.get_running_loop()
    accept, failures = loop.sock_accept, 30

    async def failing(listener: socket.socket) -> Any:
        nonlocal failures
        if failures:
            failures -= 1
            raise OSError(errno.EMFILE, "Too many open files")
        return await accept(listener)

    monkeypatch.setattr(loop, "sock_accept", failing)
    monkeypatch.setattr("editor_web.transport.acceptor.RETRY_S", 0.001)
    token_file = tmp_path / "tokens"
    async with dashboard(FakeBackend(), token_file=token_file, host=loopback, cell_view=False) as running:
        assert await session_status(running, load_access_tokens(token_file).operator) == 200
    assert failures == 0
    assert caplog.text.count("Too many open files") == 1
