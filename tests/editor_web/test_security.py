"""Everything the gate refuses, asked of the real application."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

import httpx
import pytest
import websockets.asyncio.client
from websockets.exceptions import InvalidStatus

from editor_web.access import OPERATOR, VIEWER, Access, load_access
from editor_web.app import new_app
from tests.editor_web.conftest import Serve
from tests.editor_web.fake_backend import FakeBackend
from tests.editor_web.fake_behaviors import TRANSFER

HOST = "127.0.0.1:8642"
ORIGIN = f"http://{HOST}"
START: dict[str, object] = {"behavior": TRANSFER.id, "parameters": {}}


@pytest.fixture
def access(tmp_path: Path) -> Access:
    """Fresh tokens."""
    return load_access(tmp_path / "tokens")


@pytest.fixture
def client(access: Access) -> httpx.AsyncClient:
    """A client without any credentials, at the right address."""
    app = new_app(FakeBackend(), access=access, hosts=frozenset({HOST, "localhost:8642"}), port=8642)
    return httpx.AsyncClient(transport=httpx.ASGITransport(app=app), base_url=ORIGIN)


def session(access: Access, role: str = OPERATOR) -> dict[str, str]:
    """The cookie of a logged-in browser."""
    return {"Cookie": f"flexcell_session_8642={access.session(role)}"}


async def test_another_host_name_is_refused_even_with_the_right_cookie(
    client: httpx.AsyncClient, access: Access
) -> None:
    """DNS rebinding: the browser believes evil.example is us."""
    for host in ("evil.example", "evil.example:8642", "127.0.0.1:9999", "localhost", ""):
        answer = await client.get("/api/v1/session", headers={**session(access), "Host": host})
        assert answer.status_code == 421, host


async def test_nothing_is_answered_without_a_token(client: httpx.AsyncClient) -> None:
    """API: 401; a page for a browser: to the log-in."""
    for path in ("/api/v1/session", "/api/v1/behaviors", "/api/v1/runs", "/api/v1/openapi.json", "/cell/"):
        assert (await client.get(path)).status_code == 401, path
    answer = await client.get("/", headers={"Accept": "text/html"})
    assert (answer.status_code, answer.headers["location"]) == (303, "/login")


@pytest.mark.parametrize(
    ("headers", "message"),
    [
        ({"Origin": "http://evil.example"}, "requests from other pages are refused"),
        ({"Origin": "http://127.0.0.1:3000"}, "requests from other pages are refused"),
        ({"Origin": "https://127.0.0.1:8642"}, "requests from other pages are refused"),
        ({"Origin": "null"}, "requests from other pages are refused"),
        ({}, "the Origin header is missing"),
        ({"Origin": ORIGIN, "Sec-Fetch-Site": "cross-site"}, "requests from other sites are refused"),
        ({"Origin": ORIGIN, "Sec-Fetch-Site": "same-site"}, "requests from other sites are refused"),
    ],
)
async def test_a_post_from_another_page_is_refused(
    client: httpx.AsyncClient, access: Access, headers: Mapping[str, str], message: str
) -> None:
    """Cross-site request forgery, another port of this machine included."""
    answer = await client.post("/api/v1/runs", json=START, headers={**session(access), **headers})
    assert answer.status_code == 403
    assert answer.json()["message"] == message


async def test_a_post_that_is_not_json_is_refused(client: httpx.AsyncClient, access: Access) -> None:
    """Forms of other pages can send text only."""
    answer = await client.post(
        "/api/v1/runs",
        content=b'{"behavior": "x"}',
        headers={**session(access), "Origin": ORIGIN, "Content-Type": "text/plain"},
    )
    assert answer.status_code == 422


async def test_a_viewer_may_look_and_not_act(client: httpx.AsyncClient, access: Access) -> None:
    """Read 200, act 403."""
    cookie = session(access, VIEWER)
    assert (await client.get("/api/v1/session", headers=cookie)).json()["role"] == VIEWER
    for path in ("/api/v1/runs", "/api/v1/runs/run-001/stop"):
        answer = await client.post(path, json=START, headers={**cookie, "Origin": ORIGIN})
        assert answer.status_code == 403, path


async def test_a_script_with_the_bearer_token_needs_no_origin(client: httpx.AsyncClient, access: Access) -> None:
    """The command line's way in; yet a foreign Origin is still refused."""
    bearer = {"Authorization": f"Bearer {access.operator}"}
    assert (await client.get("/api/v1/session", headers=bearer)).status_code == 200
    answer = await client.post(
        "/api/v1/runs", json={"behavior": "none"}, headers={**bearer, "Origin": "http://evil.example"}
    )
    assert answer.status_code == 403


async def test_guessing_tokens_is_slowed_down(client: httpx.AsyncClient, access: Access) -> None:
    """After ten wrong ones even the right one has to wait, at the log-in and for scripts."""
    for _ in range(10):
        answer = await client.get("/login", params={"t": "guess"})
        assert answer.status_code == 401
    for answer in (
        await client.get("/login", params={"t": access.operator}),
        await client.get("/api/v1/session", headers={"Authorization": f"Bearer {access.operator}"}),
    ):
        assert answer.status_code == 429
        assert int(answer.headers["retry-after"]) >= 1
    # Who is logged in already is not locked out.
    assert (await client.get("/api/v1/session", headers=session(access))).status_code == 200


async def test_other_sites_cannot_use_up_the_log_in_attempts(client: httpx.AsyncClient, access: Access) -> None:
    """An image tag on another page may not lock the operator out."""
    for _ in range(20):
        await client.get("/login", params={"t": "guess"}, headers={"Sec-Fetch-Site": "cross-site"})
    assert (await client.get("/login", params={"t": access.operator})).status_code == 303


async def test_the_cookie_is_out_of_reach_of_scripts_and_other_sites(client: httpx.AsyncClient, access: Access) -> None:
    """HttpOnly, SameSite=Strict, named per port, and the token leaves the address."""
    answer = await client.get("/login", params={"t": access.operator})
    cookie = answer.headers["set-cookie"]
    assert cookie.startswith("flexcell_session_8642=")
    assert "HttpOnly" in cookie
    assert "SameSite=strict" in cookie
    assert access.operator not in cookie
    assert answer.headers["location"] == "/"


async def test_a_pasted_token_logs_in_only_from_our_own_page(client: httpx.AsyncClient, access: Access) -> None:
    """The form of the log-in page."""
    form = {"token": f" {access.operator} "}
    assert (await client.post("/login", data=form, headers={"Origin": "http://evil.example"})).status_code == 403
    assert (await client.post("/login", data={"token": "x"}, headers={"Origin": ORIGIN})).status_code == 401
    assert (await client.post("/login", content=b"x" * 2000, headers={"Origin": ORIGIN})).status_code == 413
    assert (await client.post("/login", data=form, headers={"Origin": ORIGIN})).status_code == 303


async def test_every_answer_carries_the_policies(client: httpx.AsyncClient, access: Access) -> None:
    """Pages, API and refusals; scripts from ourselves only, and no framing by others."""
    for path, headers in (("/login", {}), ("/api/v1/session", session(access)), ("/api/v1/runs", {})):
        answer = await client.get(path, headers=headers)
        policy = answer.headers["content-security-policy"]
        assert "default-src 'self'" in policy
        assert "frame-ancestors 'self'" in policy
        assert "unsafe-eval" not in policy
        assert answer.headers["x-content-type-options"] == "nosniff"
        assert answer.headers["referrer-policy"] == ("same-origin" if path == "/login" else "no-referrer")
        assert answer.headers["cache-control"] == "no-store"


async def test_files_outside_the_page_are_out_of_reach(client: httpx.AsyncClient, access: Access) -> None:
    """Dots in the address lead nowhere."""
    for path in ("/assets/..%2f..%2fapp.py", "/assets/%2e%2e/%2e%2e/app.py", "/assets//etc/passwd"):
        assert (await client.get(path, headers=session(access))).status_code == 404, path


@pytest.mark.parametrize("path", ["/api/v1/live", "/cell/"])
async def test_websockets_are_refused_before_they_open(serve: Serve, path: str) -> None:
    """Foreign origin, missing origin, missing cookie, foreign host."""
    async with serve() as served:
        address = f"ws://{served.running.url.removeprefix('http://').rstrip('/')}{path}"
        tries: list[dict[str, str]] = [
            {**served.cookie, "Origin": "http://evil.example"},
            {**served.cookie},
            {"Origin": served.origin},
            {**served.cookie, "Origin": served.origin, "Sec-Fetch-Site": "cross-site"},
        ]
        for headers in tries:
            with pytest.raises(InvalidStatus) as refused:
                await websockets.asyncio.client.connect(address, additional_headers=headers, proxy=None)
            assert refused.value.response.status_code == 403, headers
