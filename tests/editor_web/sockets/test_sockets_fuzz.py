"""Every websocket with garbage, deep nesting, halves of messages and wrong types, as nobody, viewer and operator.

Whatever comes, it is closed with a code for a page at fault or goes on; nothing is logged as an error.
"""

from __future__ import annotations

import asyncio
import json
import random
from collections.abc import AsyncGenerator, Mapping
from contextlib import asynccontextmanager, suppress

import pytest
import websockets.asyncio.client
from websockets.exceptions import ConnectionClosed, InvalidStatus

from editor_web.security.authentication import OPERATOR, VIEWER, Role
from editor_web.sockets.page_socket import REFUSED
from tests.editor_web.conftest import Serve
from tests.editor_web.limits import GUARD_S
from tests.editor_web.served import Served, session_cookie
from tests.editor_web.socket_paths import message_fields, message_tags, socket_paths

PATHS = (*socket_paths("p1"), "/api/v1/none")
JSON_PATHS = [path for path in socket_paths("p1") if not path.startswith("/cell")]
DEEP = ("[" * 100_000, '{"k":' * 50_000, '{"k":"look","fields":' + "[" * 100_000)
KINDS = message_tags()
FIELDS = [*message_fields(), "no field"]
VALUES: list[object] = [
    None, True, -1, 2**70, 1e308, "", "\0", "\ud800", "x" * 10_000, [], [[]], {}, {"__proto__": 1}, [1] * 1000,
]  # fmt: skip
# What a page that is at fault is told: refused, too large, no text, or that it may not be here.
CODES = {1002, 1003, 1007, REFUSED, 1009, 1013}


def generated(seed: int) -> list[str | bytes]:
    """Messages that nearly are some of ours, and some that are nothing."""
    chance = random.Random(seed)
    made: list[str | bytes] = []
    for _ in range(4):
        body: dict[str, object] = {"k": chance.choice(KINDS)}
        body |= {chance.choice(FIELDS): chance.choice(VALUES) for _ in range(chance.randrange(4))}
        text = json.dumps(body)
        made += [text, text[: chance.randrange(len(text))], chance.randbytes(chance.randrange(200))]
    return made


@asynccontextmanager
async def opened(
    served: Served, path: str, headers: Mapping[str, str]
) -> AsyncGenerator[websockets.asyncio.client.ClientConnection]:
    """One websocket of a page."""
    async with websockets.asyncio.client.connect(
        f"{served.origin.replace('http', 'ws', 1)}{path}",
        additional_headers=headers,
        origin=websockets.Origin(served.origin),
        subprotocols=[websockets.Subprotocol("viser-v1.1.1")] if path.startswith("/cell") else None,
        compression=None,
        max_size=None,
        proxy=None,
    ) as wire:
        yield wire


async def closed(wire: websockets.asyncio.client.ClientConnection) -> int | None:
    """Wait for the end of a websocket and return its code."""
    async with asyncio.timeout(GUARD_S):
        with suppress(ConnectionClosed):
            while True:
                await wire.recv()
    return wire.close_code


def require_calm(caplog: pytest.LogCaptureFixture) -> None:
    """No error and no traceback."""
    said = [record.getMessage() for record in caplog.records if record.exc_info or record.levelname == "ERROR"]
    assert said == []


@pytest.mark.parametrize("path", JSON_PATHS)
async def test_what_is_nested_too_deeply_is_refused_with_a_reason(
    serve: Serve, path: str, caplog: pytest.LogCaptureFixture
) -> None:
    """Where messages are decoded, which is one place."""
    async with serve(cell_view="cell" in path) as served:
        for message in DEEP:
            async with opened(served, path, served.cookie) as wire:
                await wire.send(message)
                assert await closed(wire) == REFUSED
                assert (wire.close_reason or "").startswith("expected ")
    require_calm(caplog)


@pytest.mark.parametrize("role", [OPERATOR, VIEWER])
async def test_no_message_hurts_the_server(serve: Serve, role: Role, caplog: pytest.LogCaptureFixture) -> None:
    """Generated ones, each on every websocket; the next page is served."""
    async with serve(cell_view=True) as served:
        cookie = session_cookie(served.running, role)
        for number, path in enumerate(PATHS):
            for message in generated(number):
                with suppress(ConnectionClosed, InvalidStatus):
                    async with opened(served, path, cookie) as wire:
                        await wire.send(message)
                        await wire.send("last words")
                        assert path.startswith("/cell") or await closed(wire) in CODES, (path, message)
        async with served.live() as other:
            await other.until("snapshot")
    require_calm(caplog)


@pytest.mark.parametrize(
    "frame",
    [
        b"\x81\x02\xff\xfe",
        b"\x81\x81\0\0\0\0\xff",
        b"\x01\x81\0\0\0\0{",
        b"\x80\x80\0\0\0\0",
        b"\x81\xff\xff\xff\xff\xff\xff\xff\xff\xff\0\0\0\0",
        b"\x88\x81\0\0\0\0\x03",
        b"\xff" * 50,
        b"\x89\xfe\x03\xe8\0\0\0\0",
    ],
    ids=["unmasked", "no UTF-8", "half a message", "no beginning", "endless", "half a code", "garbage", "long ping"],
)
@pytest.mark.parametrize("path", ["/api/v1/live", "/api/v1/data"])
async def test_no_frame_that_is_none_leaves_a_trace(
    serve: Serve, path: str, frame: bytes, caplog: pytest.LogCaptureFixture
) -> None:
    """Byte for byte, past the client's own rules."""
    async with serve() as served:
        async with opened(served, path, served.cookie) as wire:
            wire.transport.write(frame)
            wire.transport.write_eof()
            await closed(wire)
        assert (await served.http.get("/api/v1/session")).status_code == 200
    require_calm(caplog)


@pytest.mark.parametrize("path", PATHS)
async def test_nobody_opens_any(serve: Serve, path: str, caplog: pytest.LogCaptureFixture) -> None:
    """Without a session, with one that is none, and with one that has ended."""
    async with serve() as served:
        ended = session_cookie(served.running)
        session = served.running.sessions.find(ended["Cookie"].partition("=")[2])
        assert session is not None
        served.running.sessions.end(session)
        for headers in ({}, {"Cookie": "flexcell_session_1=x"}, ended, {"Authorization": "Bearer guess"}):
            with pytest.raises(InvalidStatus) as refused:
                async with opened(served, path, headers):
                    pass
            assert refused.value.response.status_code == 403, headers
    require_calm(caplog)
