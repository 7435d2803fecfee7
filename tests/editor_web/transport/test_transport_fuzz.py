"""Too much, too slow, or garbage, on every route and websocket: refused soon, and the memory stays flat."""

from __future__ import annotations

import asyncio
import gc
import gzip
import socket
import time
import tracemalloc
from collections.abc import Generator
from contextlib import suppress
from pathlib import Path

import pytest
import websockets.asyncio.client
from websockets.exceptions import ConnectionClosed

from editor_web.security.request_rules import SAFE_METHODS
from editor_web.sockets import live_stream as live_route
from editor_web.sockets.page_socket import REFUSED, UNAVAILABLE
from editor_web.transport import request_limits as bodies
from editor_web.transport import timed_connection as connection
from editor_web.transport.request_limits import MAX_BODY_BYTES
from tests.editor_web.conftest import Serve
from tests.editor_web.fuzzing import Operation, Target, opened_target, operations
from tests.editor_web.limits import GUARD_S
from tests.editor_web.socket_paths import socket_paths
from tests.editor_web.workshop import NAP_ID
from tests.tiers import nightly

UNSAFE = [each for each in operations() if each[0] not in SAFE_METHODS]
CHUNK = b"a" * 65_536


@pytest.fixture(scope="module")
def target(tmp_path_factory: pytest.TempPathFactory, loopback: str) -> Generator[Target]:
    """One server for all."""
    with opened_target(tmp_path_factory.mktemp("bodies"), host=loopback) as opened:
        yield opened


def connected(target: Target) -> socket.socket:
    """A connection to the server."""
    host, port = target.base.removeprefix("http://").split(":")
    return socket.create_connection((host, int(port)), timeout=GUARD_S)


def head(target: Target, operation: Operation, *lines: str) -> bytes:
    """The head of an operator's request."""
    path = operation[1].replace("{run_id}", "none").replace("{", "").replace("}", "")
    common = (
        f"{operation[0]} {path} HTTP/1.1",
        f"Host: {target.base.removeprefix('http://')}",
        f"Authorization: Bearer {target.shop.access.operator}",
        "Content-Type: application/json",
        "Connection: close",
    )
    return "\r\n".join([*common, *lines, "", ""]).encode()


def read_answer(wire: socket.socket) -> bytes:
    """All that comes until the server closes; b'' where it closes without a word."""
    parts: list[bytes] = []
    try:
        while part := wire.recv(65536):
            parts.append(part)
    except ConnectionResetError:
        pass  # the server did not read what we still had to say
    return b"".join(parts)


@pytest.mark.parametrize("operation", UNSAFE, ids=lambda each: f"{each[0]} {each[1]}")
def test_an_announced_flood_is_refused_unread(target: Target, operation: Operation) -> None:
    """A gigabyte in `Content-Length`; not a byte of it has to be sent."""
    with connected(target) as wire:
        wire.sendall(head(target, operation, "Content-Length: 1000000000"))
        assert read_answer(wire).startswith(b"HTTP/1.1 413")


@pytest.mark.parametrize(
    "operation",
    [nightly(each) if n % 6 else each for n, each in enumerate(UNSAFE)],
    ids=lambda each: f"{each[0]} {each[1]}",
)
def test_a_flood_that_is_not_announced_is_cut_off(target: Target, operation: Operation) -> None:
    """In chunks, without an end: whoever reads it stops at the limit, whoever does not keeps none of it."""
    gc.collect()
    tracemalloc.start()
    sent = 0
    with connected(target) as wire:
        wire.sendall(head(target, operation, "Transfer-Encoding: chunked"))
        try:
            while sent < 1.3 * MAX_BODY_BYTES:
                wire.sendall(b"%x\r\n%s\r\n" % (len(CHUNK), CHUNK))
                sent += len(CHUNK)
            wire.shutdown(socket.SHUT_WR)
        except OSError:
            pass  # cut off
        answer = read_answer(wire)
    peak = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    status = int(answer.split(b" ", 2)[1]) if answer else 413
    target.require_calm(f"{operation}", status, answer)
    assert peak < 2.5 * MAX_BODY_BYTES, f"{peak / 1e6:.0f} MB"


def test_nothing_that_comes_compressed_is_unpacked(target: Target) -> None:
    """A bomb of 100 MB in 100 kB is 100 kB of no JSON."""
    bomb = gzip.compress(b"[" * 100_000_000)
    began_s = time.process_time()
    answer = target.http.post(
        f"{target.base}/api/v1/runs",
        data=bomb,
        headers={**target.headers("operator"), "Content-Encoding": "gzip", "Content-Type": "application/json"},
        timeout=GUARD_S,
    )
    assert answer.status_code in (400, 422)
    # Of this process, which is the server too: what else the machine does takes no part.
    assert time.process_time() - began_s < 2.0
    assert target.log.said == []


@pytest.mark.parametrize(
    "text", ["[" * 200_000, '{"a":' * 100_000, '"' + "\\u0000" * 100_000 + '"', "9" * 1_000_000, "1e999999999", "NaN"]
)
def test_json_that_is_hard_to_read_is_refused_soon(target: Target, text: str) -> None:
    """Depth, escapes and numbers that others choke on."""
    began_s = time.process_time()
    body = f'{{"behavior": "{NAP_ID}", "parameters": {{"a": {text}}}}}'.encode()
    headers = {**target.headers("operator"), "Content-Type": "application/json"}
    answer = target.http.post(f"{target.base}/api/v1/runs", data=body, headers=headers, timeout=GUARD_S)
    target.require_calm(text[:20], answer.status_code, answer.content)
    assert answer.status_code in (400, 422)
    assert time.process_time() - began_s < 5.0


def test_a_request_that_drips_is_closed_and_holds_nobody_up(target: Target, monkeypatch: pytest.MonkeyPatch) -> None:
    """A head without an end, a body without an end; 200 at once, and the page is served meanwhile."""
    # Long enough for a head to come in, also on a machine that does much else.
    monkeypatch.setattr(connection, "HEAD_LIMIT_S", 3.0)
    monkeypatch.setattr(bodies, "BODY_LIMIT_S", 0.5)
    dripping: list[socket.socket] = []
    for number in range(200):
        wire = connected(target)
        dripping.append(wire)
        if number % 2:
            wire.sendall(b"GET / HTTP/1.1\r\nHost: x\r\nX-")
        else:
            wire.sendall(head(target, ("POST", "/api/v1/runs"), "Content-Length: 100") + b"{")
    answer = target.http.get(f"{target.base}/api/v1/session", headers=target.headers("viewer"), timeout=GUARD_S)
    assert answer.status_code == 200
    for number, wire in enumerate(dripping):
        told = read_answer(wire)
        assert told == b"" if number % 2 else told.startswith(b"HTTP/1.1 408")
        wire.close()
    assert target.log.said == []


@pytest.mark.parametrize("path", ["/api/v1/live", "/cell/"])
@pytest.mark.parametrize(
    "message", ["x" * 10_000_000, b"\x00" * 10_000_000, b"\xff\xfe\x00garbage", "[[[[", '{"k":"watch","run":5}', ""],
    ids=["10 MB of text", "10 MB of bytes", "bytes", "no JSON", "another type", "nothing"],
)  # fmt: skip
async def test_no_frame_hurts_a_websocket(
    serve: Serve, path: str, message: str | bytes, caplog: pytest.LogCaptureFixture
) -> None:
    """It is closed or ignored; the server and other pages go on."""
    async with serve(cell_view=path == "/cell/") as served, served.live() as other:
        await other.until("hello")
        address = served.origin.replace("http", "ws", 1) + path
        async with websockets.asyncio.client.connect(
            address,
            additional_headers=served.cookie,
            origin=websockets.Origin(served.origin),
            subprotocols=[websockets.Subprotocol("viser-v1.1.1")] if path == "/cell/" else None,
            compression=None,
            proxy=None,
        ) as wire:
            with suppress(ConnectionClosed):  # it may be refused before all of it is sent
                await wire.send(message)
            async with asyncio.timeout(GUARD_S):
                await wire.wait_closed()
        assert (await served.http.get("/api/v1/session")).status_code == 200
        await other.send({"k": "watch", "run": ""})
        await other.until("snapshot")
    assert [record for record in caplog.records if record.exc_info or record.levelname == "ERROR"] == []


@pytest.mark.parametrize("path", [each for each in socket_paths("p1") if not each.startswith("/cell")])
@pytest.mark.parametrize(
    "message", [b"\xff\xfe\x00garbage", "[[[[", '{"k":"none"}'], ids=["bytes", "no JSON", "no word"]
)
async def test_what_a_websocket_does_not_know_ends_it(
    serve: Serve, path: str, message: str | bytes, caplog: pytest.LogCaptureFixture
) -> None:
    """With the code for a page that is at fault, so that it does not come back again and again."""
    async with serve(cell_view=True) as served:
        async with websockets.asyncio.client.connect(
            f"{served.origin.replace('http', 'ws', 1)}{path}",
            additional_headers=served.cookie,
            origin=websockets.Origin(served.origin),
            proxy=None,
        ) as wire:
            await wire.send(message)
            async with asyncio.timeout(GUARD_S):
                await wire.wait_closed()
        assert wire.close_code == REFUSED
    assert [record for record in caplog.records if record.exc_info or record.levelname == "ERROR"] == []


async def test_a_page_that_answers_no_ping_counts_as_gone(serve: Serve, monkeypatch: pytest.MonkeyPatch) -> None:
    """Its socket is open, yet nobody is there: a cable was pulled, a laptop sleeps."""
    monkeypatch.setattr(live_route, "PING_S", 0.3)
    monkeypatch.setattr(live_route, "SILENCE_S", 2.0)
    async with serve() as served, served.live() as silent, served.live() as alive:
        async with asyncio.timeout(GUARD_S):
            while silent.socket.close_code is None:
                await alive.until("ping")
                await alive.send({"k": "pong"})
        assert silent.socket.close_code == UNAVAILABLE
        await alive.until("ping")


def test_the_lists_of_what_is_fuzzed_are_not_empty(tmp_path: Path) -> None:
    """A description that lost its routes would pass all of these."""
    assert len(operations()) > 40
    assert len(UNSAFE) > 25
    assert tmp_path.exists()
