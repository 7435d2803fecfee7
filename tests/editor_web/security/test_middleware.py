"""Everything the gate refuses, asked of the real application."""

from __future__ import annotations

import asyncio
from collections.abc import Mapping
from pathlib import Path

import httpx
import pytest
import websockets.asyncio.client
from starlette.types import Receive, Scope, Send
from websockets.exceptions import InvalidStatus

from editor_web.app import new_app
from editor_web.security.authentication import OPERATOR, VIEWER, AccessTokens, AttemptLimiter, Role, load_access_tokens
from editor_web.security.login_sessions import LoginSessions
from editor_web.security.middleware import PolicyOrigins, SecurityMiddleware, response_headers
from editor_web.security.request_rules import MAX_HEADERS
from tests.editor_web.conftest import Serve
from tests.editor_web.fake_backend import FakeBackend
from tests.editor_web.fake_behaviors import TRANSFER
from tests.editor_web.limits import GUARD_S
from tests.editor_web.served import session_cookie

HOST = "127.0.0.1:8642"
ORIGIN = f"http://{HOST}"
START: dict[str, object] = {"behavior": TRANSFER.id, "parameters": {}}


@pytest.fixture
def access(tmp_path: Path) -> AccessTokens:
    """Fresh tokens."""
    return load_access_tokens(tmp_path / "tokens")


@pytest.fixture
def sessions() -> LoginSessions:
    """Nobody is logged in yet."""
    return LoginSessions(file=None, tokens="")


@pytest.fixture
def client(access: AccessTokens, sessions: LoginSessions) -> httpx.AsyncClient:
    """A client without any credentials, at the right address."""
    hosts = frozenset({HOST, "localhost:8642"})
    app = new_app(FakeBackend(), access=access, sessions=sessions, hosts=hosts, port=8642, view_port=8643)
    return httpx.AsyncClient(transport=httpx.ASGITransport(app=app), base_url=ORIGIN)


def session(sessions: LoginSessions, role: Role = OPERATOR) -> dict[str, str]:
    """The cookie of a logged-in browser, and what it says when our own page asks."""
    return {**cookie(sessions, role), "Sec-Fetch-Site": "same-origin"}


def cookie(sessions: LoginSessions, role: Role = OPERATOR) -> dict[str, str]:
    """The cookie of a logged-in browser."""
    return {"Cookie": f"flexcell_session_8642={sessions.begin(role)}"}


async def test_another_host_name_is_refused_even_with_the_right_cookie(
    client: httpx.AsyncClient, sessions: LoginSessions
) -> None:
    """DNS rebinding: the browser believes evil.example is us."""
    for host in ("evil.example", "evil.example:8642", "127.0.0.1:9999", "localhost", ""):
        answer = await client.get("/api/v1/session", headers={**session(sessions), "Host": host})
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
    client: httpx.AsyncClient, headers: Mapping[str, str], message: str, sessions: LoginSessions
) -> None:
    """Cross-site request forgery, another port of this machine included."""
    answer = await client.post("/api/v1/runs", json=START, headers={**session(sessions), **headers})
    assert answer.status_code == 403
    assert answer.json()["message"] == message


async def test_a_post_that_is_not_json_is_refused(client: httpx.AsyncClient, sessions: LoginSessions) -> None:
    """Forms of other pages can send text only."""
    answer = await client.post(
        "/api/v1/runs",
        content=b'{"behavior": "x"}',
        headers={**session(sessions), "Origin": ORIGIN, "Content-Type": "text/plain"},
    )
    assert answer.status_code == 422


async def test_a_viewer_may_look_and_not_act(client: httpx.AsyncClient, sessions: LoginSessions) -> None:
    """Read 200, act 403."""
    cookie = session(sessions, VIEWER)
    assert (await client.get("/api/v1/session", headers=cookie)).json()["role"] == VIEWER
    for path in ("/api/v1/runs", "/api/v1/runs/run-001/stop"):
        answer = await client.post(path, json=START, headers={**cookie, "Origin": ORIGIN})
        assert answer.status_code == 403, path


async def test_a_script_with_the_bearer_token_needs_no_origin(client: httpx.AsyncClient, access: AccessTokens) -> None:
    """The command line's way in; yet a foreign Origin is still refused."""
    bearer = {"Authorization": f"Bearer {access.operator}"}
    assert (await client.get("/api/v1/session", headers=bearer)).status_code == 200
    answer = await client.post(
        "/api/v1/runs", json={"behavior": "none"}, headers={**bearer, "Origin": "http://evil.example"}
    )
    assert answer.status_code == 403


async def test_wrong_tokens_are_slowed_down_and_never_refuse_a_right_one(
    client: httpx.AsyncClient, access: AccessTokens, sessions: LoginSessions
) -> None:
    """All programs of this machine share an address: what one of them tries locks nobody out."""
    for _ in range(10):
        assert (await client.get("/login", params={"t": "guess"})).status_code == 401
    wrong = {"Authorization": "Bearer guess"}
    for answer in (
        await client.get("/login", params={"t": "guess"}),
        await client.post("/login", data={"token": "guess"}, headers={"Origin": ORIGIN}),
        await client.get("/api/v1/session", headers=wrong),
        await client.post("/api/v1/runs", json=START, headers=wrong),
    ):
        assert answer.status_code == 429
        assert int(answer.headers["retry-after"]) >= 1
    right = {"Authorization": f"Bearer {access.operator}"}
    assert (await client.get("/api/v1/session", headers=right)).status_code == 200
    assert (await client.post("/api/v1/runs/run-001/stop", headers=right)).status_code != 429
    assert (await client.get("/api/v1/session", headers=session(sessions))).status_code == 200
    assert (await client.get("/login", params={"t": sessions.new_link(OPERATOR)})).status_code == 303
    form = {"token": access.operator}
    assert (await client.post("/login", data=form, headers={"Origin": ORIGIN})).status_code == 303


async def test_a_link_logs_in_once_and_is_no_token(client: httpx.AsyncClient, access: AccessTokens) -> None:
    """What stands in an address is kept in histories; only the command line makes another."""
    bearer = {"Authorization": f"Bearer {access.operator}"}
    made = (await client.post("/api/v1/login-links", json={"role": VIEWER}, headers=bearer)).json()
    token = made["token"]
    assert token not in (access.operator, access.viewer)
    assert (await client.get("/api/v1/session", headers={"Authorization": f"Bearer {token}"})).status_code == 401
    first = await client.get("/login", params={"t": token})
    assert (first.status_code, first.headers["location"]) == (303, "/")
    ours = {"Cookie": first.headers["set-cookie"].partition(";")[0], "Sec-Fetch-Site": "same-origin"}
    assert (await client.get("/api/v1/session", headers=ours)).json()["role"] == VIEWER
    client.cookies.clear()
    again = await client.get("/login", params={"t": token})
    assert (again.status_code, "flexcell login" in again.text) == (401, True)
    # Whoever is logged in already is not asked again.
    assert (await client.get("/login", params={"t": token}, headers=ours)).status_code == 303
    # The permanent tokens open nothing from an address.
    assert (await client.get("/login", params={"t": access.operator})).status_code == 401


@pytest.mark.parametrize(
    "headers",
    [{"Sec-Fetch-Site": "cross-site"}, {"Sec-Fetch-Site": "same-site"}, {"Sec-Purpose": "prefetch;prerender"}],
)
async def test_a_link_is_spent_by_who_opens_it_only(
    client: httpx.AsyncClient, sessions: LoginSessions, headers: Mapping[str, str]
) -> None:
    """Not by a page that guesses, nor by a browser that loads ahead."""
    token = sessions.new_link(OPERATOR)
    assert (await client.get("/login", params={"t": token}, headers=headers)).status_code == 200
    assert (await client.get("/login", params={"t": token})).status_code == 303


async def test_only_the_token_makes_links(
    client: httpx.AsyncClient, access: AccessTokens, sessions: LoginSessions
) -> None:
    """A page that is misused could outlive its log-out, and a viewer become an operator."""
    viewer = {"Authorization": f"Bearer {access.viewer}"}
    for headers in ({**session(sessions), "Origin": ORIGIN}, viewer):
        answer = await client.post("/api/v1/login-links", json={"role": OPERATOR}, headers=headers)
        assert answer.status_code == 403


@pytest.mark.parametrize("role", [OPERATOR, VIEWER])
async def test_logging_out_ends_the_session_for_good(
    client: httpx.AsyncClient, sessions: LoginSessions, role: Role
) -> None:
    """A copy of the cookie opens nothing any more; another browser of the same role stays."""
    ours, others = session(sessions, role), session(sessions, role)
    assert (await client.post("/api/v1/logout", headers={**ours, "Origin": ORIGIN})).status_code == 204
    assert (await client.get("/api/v1/session", headers=ours)).status_code == 401
    assert (await client.get("/api/v1/session", headers=others)).status_code == 200


async def test_other_sites_cannot_use_up_the_log_in_attempts(client: httpx.AsyncClient) -> None:
    """An image tag on another page may not lock the operator out."""
    for _ in range(20):
        await client.get("/login", params={"t": "guess"}, headers={"Sec-Fetch-Site": "cross-site"})
    assert (await client.get("/login", params={"t": "guess"})).status_code == 401


async def test_the_cookie_is_out_of_reach_of_scripts_and_other_sites(
    client: httpx.AsyncClient, access: AccessTokens, sessions: LoginSessions
) -> None:
    """HttpOnly, SameSite=Strict, named per port, and the token leaves the address."""
    answer = await client.get("/login", params={"t": sessions.new_link(OPERATOR)})
    cookie = answer.headers["set-cookie"]
    assert cookie.startswith("flexcell_session_8642=")
    assert "HttpOnly" in cookie
    assert "SameSite=strict" in cookie
    assert access.operator not in cookie
    assert answer.headers["location"] == "/"


async def test_a_pasted_token_logs_in_only_from_our_own_page(client: httpx.AsyncClient, access: AccessTokens) -> None:
    """The form of the log-in page."""
    form = {"token": f" {access.operator} "}
    assert (await client.post("/login", data=form, headers={"Origin": "http://evil.example"})).status_code == 403
    assert (await client.post("/login", data={"token": "x"}, headers={"Origin": ORIGIN})).status_code == 401
    assert (await client.post("/login", content=b"x" * 2000, headers={"Origin": ORIGIN})).status_code == 413
    assert (await client.post("/login", data=form, headers={"Origin": ORIGIN})).status_code == 303


async def test_every_answer_carries_the_policies(client: httpx.AsyncClient, sessions: LoginSessions) -> None:
    """Pages, API and refusals; scripts from ourselves only, and no framing by others."""
    for path, headers in (("/login", {}), ("/api/v1/session", session(sessions)), ("/api/v1/runs", {})):
        answer = await client.get(path, headers=headers)
        policy = answer.headers["content-security-policy"]
        assert "default-src 'self'" in policy
        assert "frame-ancestors 'self'" in policy
        assert "unsafe-eval" not in policy
        assert answer.headers["x-content-type-options"] == "nosniff"
        assert answer.headers["referrer-policy"] == ("same-origin" if path == "/login" else "no-referrer")
        assert answer.headers["cache-control"] == "no-store"


async def test_files_outside_the_page_are_out_of_reach(client: httpx.AsyncClient, sessions: LoginSessions) -> None:
    """Dots in the address lead nowhere."""
    for path in (
        "/assets/" + "a" * 5000,
        "/assets/..%2f..%2fapp.py",
        "/assets/%2e%2e/%2e%2e/app.py",
        "/assets//etc/passwd",
    ):
        assert (await client.get(path, headers=session(sessions))).status_code == 404, path


POLICY = "content-security-policy"
READS = ("/api/v1/session", "/api/v1/behaviors", "/api/v1/openapi.json", "/cell/")


async def test_a_page_of_another_port_reads_nothing(client: httpx.AsyncClient, sessions: LoginSessions) -> None:
    """Browsers send it our cookie, as ports make no difference to cookies."""
    for path in READS:
        for headers in (
            {"Sec-Fetch-Site": "same-site"},
            {"Sec-Fetch-Site": "cross-site"},
            {"Sec-Fetch-Site": "same-site", "Sec-Fetch-Mode": "navigate", "Sec-Fetch-Dest": "document"},
            {"Sec-Fetch-Site": "same-site", "Sec-Fetch-Mode": "navigate", "Sec-Fetch-Dest": "iframe"},
            {"Origin": "http://127.0.0.1:3000"},
            {},
        ):
            answer = await client.get(path, headers={**cookie(sessions), **headers})
            assert answer.status_code == 403, (path, headers)
        for headers in ({"Sec-Fetch-Site": "same-origin"}, {"Sec-Fetch-Site": "none"}, {"Origin": ORIGIN}):
            answer = await client.get(path, headers={**cookie(sessions), **headers})
            assert answer.status_code in (200, 404), (path, headers)


async def test_the_3d_view_is_framed_by_our_page_under_an_origin_of_its_own(
    client: httpx.AsyncClient, sessions: LoginSessions
) -> None:
    """Where there is nothing else: it runs code of others, which reaches neither the page nor what the page may do."""
    frame = {"Sec-Fetch-Site": "same-site", "Sec-Fetch-Mode": "navigate", "Sec-Fetch-Dest": "iframe"}
    view = {**cookie(sessions), "Host": "127.0.0.1:8643"}
    answer = await client.get("/cell/p1/", headers={**view, **frame})
    # There is no 3D view behind this server; but it was let through.
    assert answer.status_code == 404
    assert answer.headers["origin-agent-cluster"] == "?1"
    assert "frame-ancestors 'self' http://127.0.0.1:8642;" in answer.headers[POLICY]
    page = await client.get("/login")
    assert "frame-src 'self' http://127.0.0.1:8643;" in page.headers[POLICY]
    assert "origin-agent-cluster" not in page.headers
    named = await client.get("/login", headers={"Host": "localhost:8642"})
    assert "frame-src 'self' http://localhost:8643;" in named.headers[POLICY]
    for changed in ({"Sec-Fetch-Site": "cross-site"}, {"Sec-Fetch-Dest": "document"}, {"Sec-Fetch-Mode": "cors"}):
        assert (await client.get("/cell/p1/", headers={**view, **frame, **changed})).status_code == 403, changed
    for path in ("/", "/login", "/api/v1/session"):
        answer = await client.get(path, headers={**view, "Sec-Fetch-Site": "same-origin"})
        assert (answer.status_code, "3D view" in answer.text) == (404, True), path


async def test_the_3d_view_asks_the_page_s_server_for_nothing(
    client: httpx.AsyncClient, sessions: LoginSessions
) -> None:
    """What its scripts send there counts as that of any other page."""
    for site in ("same-site", "cross-site"):
        asks = {**cookie(sessions), "Origin": "http://127.0.0.1:8643", "Sec-Fetch-Site": site}
        assert (await client.post("/api/v1/cell/stop", headers=asks)).status_code == 403
        assert (await client.get("/api/v1/session", headers=asks)).status_code == 403


async def test_a_link_elsewhere_leads_to_the_page(client: httpx.AsyncClient, sessions: LoginSessions) -> None:
    """It holds no data; as a frame or a script it is refused."""
    foreign = {**cookie(sessions), "Sec-Fetch-Site": "same-site", "Sec-Fetch-Mode": "navigate"}
    opened = await client.get("/runs", headers={**foreign, "Sec-Fetch-Dest": "document"})
    assert opened.status_code in (200, 503)
    for use in ("iframe", "script", "image"):
        assert (await client.get("/runs", headers={**foreign, "Sec-Fetch-Dest": use})).status_code == 403


@pytest.mark.parametrize("name", ["Host", "Origin", "Cookie", "Authorization", "Sec-Fetch-Site", "Content-Type"])
async def test_headers_that_are_read_once_are_there_once(
    client: httpx.AsyncClient, access: AccessTokens, name: str
) -> None:
    """Or one part of a server could believe the first, and another the second."""
    values = {"Host": HOST, "Origin": ORIGIN, "Authorization": f"Bearer {access.operator}"}
    value = values.get(name, "x")
    others = [(key, each) for key, each in values.items() if key != name]
    answer = await client.post("/api/v1/runs", headers=[*others, (name, value), (name.lower(), value)])
    assert answer.status_code == 400
    assert name.lower() in answer.json()["message"]


async def test_an_absurd_number_of_headers_is_refused(client: httpx.AsyncClient, access: AccessTokens) -> None:
    """Many, or long ones."""
    bearer = {"Authorization": f"Bearer {access.operator}"}
    for headers in ({f"x-{number}": "1" for number in range(MAX_HEADERS + 1)}, {"x-long": "x" * 20_000}):
        assert (await client.get("/api/v1/session", headers={**bearer, **headers})).status_code == 431


@pytest.mark.parametrize("odd", ["%00", "%0a", "%7f", "%ff", "%c0%af", "%ed%a0%80"])
@pytest.mark.parametrize(
    "path", ["/assets/{}", "/api/v1/runs/{}", "/api/v1/documents/behaviors/{}.yaml", "/edit/{}", "/{}"]
)
async def test_control_characters_in_an_address_are_refused(
    client: httpx.AsyncClient, access: AccessTokens, path: str, odd: str
) -> None:
    """In one place, for all routes."""
    bearer = {"Authorization": f"Bearer {access.operator}"}
    answer = await client.get(path.format(f"a{odd}b"), headers=bearer)
    assert answer.status_code == 400


def test_the_page_may_connect_to_what_it_is_given() -> None:
    """And to nothing else."""
    policy = response_headers("/", PolicyOrigins(connect_sources=("http://127.0.0.1:9",)))["content-security-policy"]
    assert "connect-src 'self' http://127.0.0.1:9; " in policy
    assert "connect-src 'self'; " in response_headers("/")["content-security-policy"]


async def test_commands_of_an_operator_are_served_beyond_the_capacity(access: AccessTokens) -> None:
    """Whatever else is open: pages, viewers and streams are refused, a stop is not."""
    entered, leave = asyncio.Event(), asyncio.Event()

    async def app(scope: Scope, receive: Receive, send: Send) -> None:
        del receive
        if scope["method"] == "GET":
            entered.set()
            await leave.wait()
        await send({"type": "http.response.start", "status": 204, "headers": []})
        await send({"type": "http.response.body", "body": b""})

    sessions = LoginSessions(file=None, tokens="")
    limit = AttemptLimiter(now_s=lambda: 0.0)
    hosts = frozenset({HOST})
    gate = SecurityMiddleware(app, access=access, sessions=sessions, limit=limit, hosts=hosts, port=8642, capacity=1)
    bearer, viewer = ({"Authorization": f"Bearer {token}"} for token in (access.operator, access.viewer))
    async with httpx.AsyncClient(transport=httpx.ASGITransport(app=gate), base_url=ORIGIN) as client:
        held = asyncio.create_task(client.get("/api/v1/bus/echo", headers=viewer))
        await entered.wait()
        for headers in (viewer, bearer):
            refused = await client.get("/api/v1/session", headers=headers)
            assert (refused.status_code, refused.headers["retry-after"]) == (503, "1")
        assert (await client.post("/api/v1/cell/stop", headers=bearer)).status_code == 204
        leave.set()
        assert (await held).status_code == 204
        assert (await client.get("/api/v1/session", headers=bearer)).status_code == 204


@pytest.mark.parametrize("path", ["/api/v1/live", "/api/v1/data", "/api/v1/teach/live", "/cell/"])
async def test_logging_out_closes_what_is_open(serve: Serve, path: str) -> None:
    """The websockets of this browser, and of no other."""
    async with serve(cell_view=path == "/cell/") as served:
        address = f"ws://{served.running.url.removeprefix('http://').rstrip('/')}{path}"
        ours, others = (session_cookie(served.running) for _ in range(2))

        def connect(headers: Mapping[str, str]) -> websockets.asyncio.client.connect:
            origin = websockets.Origin(served.origin)
            protocols = [websockets.Subprotocol("viser-v1.1.1")] if path == "/cell/" else None
            return websockets.asyncio.client.connect(
                address, additional_headers=headers, origin=origin, subprotocols=protocols, max_size=None, proxy=None
            )

        async with connect(ours) as leaving, connect(others) as staying:
            answer = await served.http.post(
                "/api/v1/logout", headers={**ours, "Origin": served.origin, "Authorization": ""}
            )
            assert answer.status_code == 204
            async with asyncio.timeout(GUARD_S):
                await leaving.wait_closed()
            assert (leaving.close_code, leaving.close_reason) == (1008, "logged out")
            assert staying.close_code is None
            async with asyncio.timeout(GUARD_S):
                await (await staying.ping())


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
