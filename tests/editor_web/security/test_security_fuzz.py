"""Every route and every websocket from the wrong place, and every path parameter as a way out of the project."""

from __future__ import annotations

import re
import socket
from collections.abc import Generator
from urllib.parse import quote

import pytest

from editor_web.security.authentication import OPERATOR
from editor_web.security.middleware import cookie_name
from editor_web.security.request_rules import SAFE_METHODS
from tests.editor_web.fuzzing import HOSTILE_PATHS, Operation, Target, opened_target, operations
from tests.editor_web.limits import GUARD_S
from tests.editor_web.socket_paths import socket_paths
from tests.editor_web.workshop import SHIFT_ID

EVIL = "evil.example"
UPGRADE = {
    "Connection": "Upgrade",
    "Upgrade": "websocket",
    "Sec_WebSocket_Key": "A" * 22 + "==",
    "Sec_WebSocket_Version": "13",
}
NAME = re.compile(r"\{\w+\}")


@pytest.fixture(scope="module")
def target(tmp_path_factory: pytest.TempPathFactory, loopback: str) -> Generator[Target]:
    """One server for all."""
    with opened_target(tmp_path_factory.mktemp("gate"), host=loopback) as opened:
        yield opened


def ask(target: Target, operation: Operation, path: str, body: bytes, **headers: str) -> tuple[int, bytes]:
    """Send a request as it is, byte for byte: no client tidies the address."""
    host, port = target.base.removeprefix("http://").split(":")
    lines = {"Host": f"{host}:{port}", "Content-Type": "application/json", "Connection": "close", **headers}
    head = "".join(f"{name.replace('_', '-')}: {value}\r\n" for name, value in lines.items())
    text = f"{operation[0]} {path} HTTP/1.1\r\n{head}Content-Length: {len(body)}\r\n\r\n".encode() + body
    with socket.create_connection((host, int(port)), timeout=GUARD_S) as wire:
        wire.sendall(text)
        answer = b"".join(iter(lambda: wire.recv(65536), b""))
    return int(answer.split(b" ", 2)[1]), answer


def session(target: Target) -> str:
    """The cookie of an operator's browser."""
    return f"{cookie_name(target.shop.running.port)}={target.shop.running.sessions.begin(OPERATOR)}"


@pytest.mark.parametrize("operation", operations(), ids=lambda each: f"{each[0]} {each[1]}")
def test_every_route_is_shut_from_outside(target: Target, operation: Operation) -> None:
    """A foreign host name, a foreign page, a page of another port, an opaque one, another site: all with the cookie."""
    path = NAME.sub(quote(SHIFT_ID), operation[1])
    before = target.inside(), len(target.shop.session.runs())
    assert ask(target, operation, path, b"{}", Host=EVIL, Cookie=session(target))[0] == 421
    if operation[0] in SAFE_METHODS:
        assert ask(target, operation, path, b"", Cookie="x=y")[0] == 401
    else:
        for origin in (f"http://{EVIL}", "http://127.0.0.1:1", "null", ""):
            assert ask(target, operation, path, b"{}", Cookie=session(target), Origin=origin)[0] == 403, origin
        own = {"Cookie": session(target), "Origin": target.base}
        assert ask(target, operation, path, b"{}", Sec_Fetch_Site="cross-site", **own)[0] == 403
    assert (target.inside(), len(target.shop.session.runs())) == before
    assert target.log.said == []


@pytest.mark.parametrize("path", socket_paths("page1"))
def test_every_websocket_is_shut_from_outside(target: Target, path: str) -> None:
    """Before it opens."""
    own = {"Cookie": session(target)}
    page = {"Origin": target.base}
    for headers in (
        {**own, **page, "Host": EVIL},
        {**own, "Origin": f"http://{EVIL}"},
        {**own, "Origin": "null"},
        own,
        page,
        {**own, **page, "Sec_Fetch_Site": "cross-site"},
        {**page, "Cookie": "flexcell_session=1"},
        {"Authorization": "Bearer guess"},
    ):
        assert ask(target, ("GET", path), path, b"", **UPGRADE, **headers)[0] == 403, headers


@pytest.mark.parametrize("operation", [each for each in operations() if "{" in each[1]], ids=lambda e: f"{e[0]} {e[1]}")
def test_no_path_leads_out_of_the_project(target: Target, operation: Operation) -> None:
    """Encoded once, twice or not at all, with NUL, backslashes and through links."""
    bearer = f"Bearer {target.shop.access.operator}"
    for hostile in HOSTILE_PATHS:
        for name in {hostile.replace(" ", ""), quote(hostile, safe=""), quote(quote(hostile, safe=""), safe="")}:
            path = operation[1].replace(NAME.findall(operation[1])[0], name)
            status, answer = ask(target, operation, path, b"{}", Authorization=bearer)
            target.require_calm(f"{operation} {name}", status, answer)
            assert b"password" not in answer
    target.require_untouched_surroundings()


def test_no_new_document_lies_outside_of_the_project(target: Target) -> None:
    """Nor is one copied or moved there."""
    bearer = {"Authorization": f"Bearer {target.shop.access.operator}"}
    for hostile in HOSTILE_PATHS:
        for path, body in (
            ("", {"id": hostile, "template": "empty", "name": "x"}),
            ("", {"id": hostile}),
            (f"/{SHIFT_ID}/duplicate", {"id": hostile}),
            (f"/{SHIFT_ID}/rename", {"id": hostile}),
        ):
            answer = target.http.post(
                f"{target.base}/api/v1/documents{path}", json=body, headers=bearer, timeout=GUARD_S
            )
            target.require_calm(f"{path} {hostile}", answer.status_code, answer.content)
        target.restore()
    target.require_untouched_surroundings()
