"""What a peer owes and does not send, or is sent and does not take: the connection ends, and nothing is logged."""

from __future__ import annotations

import asyncio
import socket
from collections.abc import AsyncGenerator
from contextlib import asynccontextmanager

import msgspec
import pytest

from editor_web import server
from editor_web.http_bodies.common_bodies import ErrorBody
from editor_web.transport import request_limits as bodies
from editor_web.transport import timed_connection as connection
from tests.editor_web.conftest import Serve
from tests.editor_web.limits import GUARD_S
from tests.editor_web.served import Served

VISER = "Sec-WebSocket-Protocol: viser-v1.1.1\r\n"
UPGRADE = "Upgrade: websocket\r\nConnection: Upgrade\r\nSec-WebSocket-Version: 13\r\n"
KEY = f"Sec-WebSocket-Key: {'A' * 22}==\r\n"


class RawPeer:
    """A peer that sends what it is told to, byte for byte."""

    def __init__(self, wire: socket.socket) -> None:
        self._wire = wire
        self._loop = asyncio.get_running_loop()

    @classmethod
    @asynccontextmanager
    async def connected(cls, served: Served, *, buffer: int = 0) -> AsyncGenerator[RawPeer]:
        """Connect; with `buffer` bytes for what comes, where given."""
        host, port = served.origin.removeprefix("http://").split(":")
        with socket.socket() as wire:
            wire.setblocking(False)
            if buffer:
                wire.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, buffer)
            await asyncio.get_running_loop().sock_connect(wire, (host, int(port)))
            yield cls(wire)

    async def send(self, text: str) -> None:
        """Send it."""
        async with asyncio.timeout(GUARD_S):
            await self._loop.sock_sendall(self._wire, text.encode("latin-1"))

    async def send_for_ever(self, text: str) -> None:
        """Send it again and again; raises ConnectionError when the server does not take it."""
        while True:
            await self.send(text)

    async def all(self) -> bytes:
        """Return what comes until the server closes, without closing our side before."""
        parts: list[bytes] = []
        async with asyncio.timeout(GUARD_S):
            try:
                while part := await self._loop.sock_recv(self._wire, 65536):
                    parts.append(part)
            except ConnectionResetError:
                pass  # it was closed on what we had sent
        return b"".join(parts)

    async def whole(self) -> bytes:
        """Return what comes until the server ends its side; raises ConnectionResetError."""
        parts: list[bytes] = []
        async with asyncio.timeout(GUARD_S):
            while part := await self._loop.sock_recv(self._wire, 65536):
                parts.append(part)
        return b"".join(parts)

    async def some(self) -> bytes:
        """Return what comes next."""
        async with asyncio.timeout(GUARD_S):
            return await self._loop.sock_recv(self._wire, 65536)


def head(served: Served, line: str, *lines: str) -> str:
    """The head of a request to this server."""
    return "\r\n".join([line, f"Host: {served.origin.removeprefix('http://')}", *lines, "", ""])


@pytest.mark.parametrize("path", ["/api/v1/runs", "/login", "/api/v1/none"])
async def test_a_body_that_drips_ends_also_where_nobody_reads_it(
    serve: Serve, monkeypatch: pytest.MonkeyPatch, path: str, caplog: pytest.LogCaptureFixture
) -> None:
    """Refused at the gate or read by a route: each byte prolongs nothing."""
    monkeypatch.setattr(bodies, "BODY_LIMIT_S", 0.3)
    monkeypatch.setattr(connection, "BODY_GRACE_S", 0.1)
    async with serve() as served, RawPeer.connected(served) as peer:
        await peer.send(head(served, f"POST {path} HTTP/1.1", f"Origin: {served.origin}", "Content-Length: 1000"))
        dripping = asyncio.create_task(drip(peer))
        answer = await peer.all()
        dripping.cancel()
        await asyncio.wait({dripping})
        # Where the machine is busy, the connection is closed before the route has said so.
        assert answer[:12] in (b"HTTP/1.1 401", b"HTTP/1.1 408", b"")
    assert [record for record in caplog.records if record.levelname == "ERROR"] == []


async def drip(peer: RawPeer) -> None:
    """Send a byte now and then until the other side has enough of it."""
    try:
        while True:
            await peer.send("x")
            await asyncio.sleep(0.02)
    except OSError:
        return


@pytest.mark.parametrize("path", ["/api/v1/live", "/api/v1/data", "/api/v1/teach/live", "/cell/p1/"])
async def test_a_websocket_that_is_silent_is_closed(
    serve: Serve, monkeypatch: pytest.MonkeyPatch, path: str, caplog: pytest.LogCaptureFixture
) -> None:
    """One that answers no ping of the protocol, whatever it is for; it does not even take what it is sent."""
    monkeypatch.setattr(server, "PING_S", 0.2)
    monkeypatch.setattr(server, "SILENCE_S", 0.5)
    async with serve(cell_view=path.startswith("/cell/")) as served, RawPeer.connected(served) as peer:
        cookie = f"Cookie: {served.cookie['Cookie']}"
        await peer.send(
            head(served, f"GET {path} HTTP/1.1", f"Origin: {served.origin}", cookie, (UPGRADE + VISER + KEY).strip())
        )
        assert b" 101 " in await peer.some()
        await peer.all()
    assert [record for record in caplog.records if record.levelname == "ERROR"] == []


async def test_a_peer_that_takes_no_answer_is_closed(serve: Serve, monkeypatch: pytest.MonkeyPatch) -> None:
    """It asks again and again and reads nothing, which needs no token."""
    monkeypatch.setattr(connection, "WRITE_LIMIT_S", 0.3)
    async with serve() as served, RawPeer.connected(served, buffer=4096) as peer:
        question = head(served, "GET /login HTTP/1.1") * 200
        with pytest.raises(ConnectionError):
            await flood(peer, question)
        assert (await served.http.get("/api/v1/session")).status_code == 200


async def flood(peer: RawPeer, question: str) -> None:
    """Ask until the other side has enough of it."""
    while True:
        await peer.send(question)


@pytest.mark.parametrize(
    ("line", "lines"),
    [
        ("POST /api/v1/live HTTP/1.1", KEY),
        ("GET /api/v1/live HTTP/1.0", KEY),
        ("GET /api/v1/live HTTP/1.1", ""),
        ("GET /api/v1/live HTTP/1.1", "Sec-WebSocket-Key: short\r\n"),
        ("GET /api/v1/live HTTP/1.1", KEY + "Content-Length: 5\r\n"),
        ("GET /api/v1/live HTTP/1.1", KEY + "X-Long: " + "x" * 9000 + "\r\n"),
        ("GET /api/v1/live HTTP/1.1", KEY + "".join(f"X-{n}: 1\r\n" for n in range(200))),
        ("GET /api/v1/live HTTP/1.1", KEY + "Origin: a\r\nOrigin: b\r\n"),
        ("GET /api/v1/live HTTP/1.1", KEY + "Cookie: \xff\xfe\r\n"),
    ],
    ids=["post", "old", "no key", "short key", "body", "long header", "many headers", "two origins", "odd bytes"],
)
async def test_a_handshake_that_is_none_is_refused(
    serve: Serve, line: str, lines: str, caplog: pytest.LogCaptureFixture
) -> None:
    """Before anybody is asked who they are; without a traceback."""
    async with serve() as served, RawPeer.connected(served) as peer:
        await peer.send(head(served, line, (UPGRADE + lines).strip()))
        status = int((await peer.all()).split(b" ", 2)[1])
        assert 400 <= status < 500
    said = [record.getMessage() for record in caplog.records if record.exc_info or record.levelname == "ERROR"]
    assert said == []


@pytest.mark.parametrize(
    ("text", "status", "words"),
    [
        ("GET /api/v1/runs?watches=" + "x" * 240_000, 431, "an address with its headers may have at most 65536 bytes"),
        ("GET /api/v1/runs HTTP/1.1\r\nno header\r\n\r\n", 400, "this is no valid HTTP request"),
    ],
    ids=["long address", "no header"],
)
async def test_what_cannot_be_read_is_refused_in_json_as_all_refusals_are(
    serve: Serve, text: str, status: int, words: str
) -> None:
    """With the status that the description of the interface names; the server goes on."""
    async with serve() as served:
        async with RawPeer.connected(served) as peer:
            await peer.send(text)
            first, _, rest = (await peer.all()).partition(b"\r\n")
            heads, _, body = rest.partition(b"\r\n\r\n")
        assert int(first.split(b" ")[1]) == status
        assert b"application/json" in heads.lower()
        assert words in msgspec.json.decode(body, type=ErrorBody).message
        assert (await served.http.get("/api/v1/session")).status_code == 200


async def test_who_is_refused_while_he_sends_can_send_it_all_and_reads_the_answer(serve: Serve) -> None:
    """Closing on what is unread would reset the connection, and the answer with it."""
    async with serve() as served, RawPeer.connected(served) as peer:
        await peer.send(head(served, "GET /api/v1/runs?watches=" + "x" * 4_000_000 + " HTTP/1.1"))
        answer = await peer.whole()
    assert answer.startswith(b"HTTP/1.1 431 ")


async def test_who_goes_on_sending_after_a_refusal_is_disconnected(serve: Serve) -> None:
    """What he sends is thrown away, for a second."""
    async with serve() as served, RawPeer.connected(served) as peer:
        await peer.send("no HTTP\r\n\r\n")
        with pytest.raises(ConnectionError):
            await peer.send_for_ever("x" * 4096)
