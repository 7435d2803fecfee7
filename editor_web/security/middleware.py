"""Security middleware for every request: host, origin, session, role and response headers.

It is a plain ASGI middleware, because it must also protect websockets, to which browsers do not apply the same-origin
policy.
"""

from __future__ import annotations

import asyncio
import logging
from collections.abc import Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass
from http.cookies import CookieError, SimpleCookie
from typing import Self

from starlette.requests import ClientDisconnect
from starlette.types import ASGIApp, Message, Receive, Scope, Send

from editor_web.security.authentication import OPERATOR, AccessTokens, AttemptLimiter, Role
from editor_web.security.login_sessions import LoginSession, LoginSessions
from editor_web.security.request_rules import (
    VIEW_PATH,
    RequestRefusal,
    is_unsafe,
    refuse_cross_site,
    refuse_malformed,
    refuse_unproven_cookie,
)
from editor_web.transport.capacity import MAX_CONNECTIONS
from editor_web.transport.request_limits import TOO_LARGE, declares_too_large, limit_body, refusal_body

PAGE_POLICY = (
    "default-src 'self'; style-src 'self' 'unsafe-inline'; img-src 'self' data:; font-src 'self' data:; "
    "worker-src 'self' blob:; connect-src 'self'{sources}; frame-src 'self'{views}; frame-ancestors 'self'; "
    "object-src 'none'; base-uri 'none'; form-action 'self'"
)
# viser's page is one file with inline scripts and wasm; this policy allows them under its own path only.
CELL_POLICY = (
    "default-src 'self'; script-src 'self' 'unsafe-inline' 'unsafe-eval' blob:; style-src 'self' 'unsafe-inline'; "
    "img-src 'self' data: blob:; font-src 'self' data:; worker-src 'self' blob: data:; "
    "connect-src 'self' data: blob:; frame-ancestors 'self'{pages}; object-src 'none'; base-uri 'none'"
)
OPEN_PATHS = frozenset({"/login", "/favicon.svg"})
LOG_OUT = "/api/v1/logout"

_audit = logging.getLogger("flexcell.audit")


def cookie_name(port: int) -> str:
    """Return the name of the session cookie, with the port: browsers share cookies between the ports of a host."""
    return f"flexcell_session_{port}"


@dataclass(frozen=True, kw_only=True)
class Principal:
    """The sender of a request: role, and browser session; the session is None for a token and on public paths."""

    role: Role | None
    session: LoginSession | None


class SecurityMiddleware:
    """Admits a request to `app` if its form, host, origin and credentials are valid.

    A valid token or session is always admitted, regardless of failed attempts of others.

    Args:
        app: The protected application.
        access: The access tokens.
        sessions: The sessions of logged-in browsers.
        limit: Limits wrong bearer tokens, shared with the login page.
        hosts: Accepted values of the Host header, with port, in lower case.
        port: Port of this server, for the cookie's name.
        capacity: Maximum number of concurrent requests and websockets; only an operator's commands, such as a stop,
            are served beyond it.
        connect_sources: Additional origins that the page may connect to.
        view_port: Port that serves the 3D view only: a separate origin, so that browsers isolate its process and it
            has no access to the page around it. None without a 3D view.
    """

    def __init__(
        self,
        app: ASGIApp,
        *,
        access: AccessTokens,
        sessions: LoginSessions,
        limit: AttemptLimiter,
        hosts: frozenset[str],
        port: int,
        capacity: int = MAX_CONNECTIONS,
        connect_sources: Sequence[str] = (),
        view_port: int | None = None,
    ) -> None:
        self._app = app
        self._access = access
        self._sessions = sessions
        self._limit = limit
        self._cookie = cookie_name(port)
        self._capacity = capacity
        self._page_hosts = {host: PolicyOrigins.beside(host, view_port, connect_sources) for host in hosts}
        at_view = () if view_port is None else ((_at(host, view_port), of) for host, of in self._page_hosts.items())
        self._view_hosts = dict(at_view)
        self._elsewhere = PolicyOrigins(connect_sources=connect_sources)
        self._open = 0

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Serve or refuse one request or websocket."""
        if scope["type"] == "lifespan":
            await self._app(scope, receive, send)
            return
        verdict = refuse_malformed(scope) or self._judge(scope)
        if isinstance(verdict, RequestRefusal):
            await self._refuse(scope, receive, send, verdict)
            return
        self._open += 1
        try:
            await self._serve(scope, receive, send, verdict)
        finally:
            self._open -= 1

    async def _serve(self, scope: Scope, receive: Receive, send: Send, principal: Principal) -> None:
        scope.setdefault("state", {}).update(role=principal.role, session=principal.session)
        if principal.session is not None:
            receive = while_logged_in(receive, send, self._sessions, principal.session, kind=scope["type"])
        if scope["type"] == "websocket":
            await self._app(scope, receive, send)
            return
        try:
            await self._app(scope, limit_body(receive), _with_headers(self._headers(scope), send))
        except ClientDisconnect:
            # A client that disconnects during its request needs no response, and this is not a server error.
            return

    async def _refuse(self, scope: Scope, receive: Receive, send: Send, refusal: RequestRefusal) -> None:
        if scope["type"] == "websocket":
            await receive()
            await send({"type": "websocket.close", "code": 1008, "reason": refusal.message})
        else:
            await _answer(self._headers(scope), send, refusal)

    def _headers(self, scope: Scope) -> dict[str, str]:
        host = next((value.decode("latin-1").lower() for name, value in scope["headers"] if name == b"host"), "")
        origins = self._page_hosts.get(host) or self._view_hosts.get(host) or self._elsewhere
        return response_headers(scope["path"], origins)

    def _judge(self, scope: Scope) -> Principal | RequestRefusal:
        headers = {name.decode("latin-1"): value.decode("latin-1") for name, value in scope["headers"]}
        bearer = _bearer(headers)
        is_open = scope["path"] in OPEN_PATHS and scope["type"] == "http"
        host = headers.get("host", "").lower()
        is_view = host in self._view_hosts
        if host not in self._page_hosts and not is_view:
            return RequestRefusal(status=421, message="this server does not accept this host name")
        if is_view and not scope["path"].startswith(VIEW_PATH):
            return RequestRefusal(status=404, message="this address serves only the 3D view")
        if declares_too_large(headers):
            return RequestRefusal(status=413, message=TOO_LARGE)
        if not is_open or is_unsafe(scope):
            refusal = refuse_cross_site(scope, headers, has_token=bool(bearer), is_framed=is_view)
            if refusal is not None:
                return refusal
        if is_open:
            return Principal(role=None, session=self._session(headers))
        principal = self._by_token(scope, bearer) if bearer else self._by_cookie(scope, headers)
        if isinstance(principal, RequestRefusal):
            return principal
        return self._forbidden(scope, principal) or principal

    def _by_token(self, scope: Scope, token: str) -> Principal | RequestRefusal:
        role = self._access.role_of_token(token)
        if role is not None:
            return Principal(role=role, session=None)
        wait_s = self._limit.failed(peer_of(scope))
        if wait_s == 0:
            return _not_logged_in()
        return RequestRefusal(
            status=429, message="too many wrong tokens", headers={"retry-after": str(int(wait_s) + 1)}
        )

    def _by_cookie(self, scope: Scope, headers: Mapping[str, str]) -> Principal | RequestRefusal:
        session = self._session(headers)
        if session is not None:
            return refuse_unproven_cookie(scope, headers) or Principal(role=session.role, session=session)
        wants_page = scope["type"] == "http" and "text/html" in headers.get("accept", "") and scope["method"] == "GET"
        if wants_page:
            return RequestRefusal(status=303, message="log in first", headers={"location": "/login"})
        return _not_logged_in()

    def _session(self, headers: Mapping[str, str]) -> LoginSession | None:
        try:
            cookie = SimpleCookie(headers.get("cookie", "")).get(self._cookie)
        except CookieError:
            return None
        return self._sessions.find(cookie.value) if cookie else None

    def _forbidden(self, scope: Scope, principal: Principal) -> RequestRefusal | None:
        """Refuse a request that the role does not allow or that exceeds the capacity; log commands."""
        is_command = is_unsafe(scope) and scope["type"] == "http"
        is_logout = principal.session is not None and scope["path"] == LOG_OUT
        if is_command and principal.role != OPERATOR and not is_logout:
            return RequestRefusal(status=403, message="a viewer has read-only access; log in with the operator token")
        if self._open >= self._capacity and not is_command:
            return RequestRefusal(
                status=503, message="too many pages and requests at once", headers={"retry-after": "1"}
            )
        if is_command:
            # The query is omitted: it could contain a secret.
            _audit.info("%s %s by %s", scope["method"], scope["path"], principal.role)
        return None


def peer_of(scope: Scope) -> str:
    """Return the sender's address of a request; all programs of a machine share one."""
    client: tuple[str, int] | None = scope.get("client")
    return client[0] if client else ""


def while_logged_in(
    receive: Receive, send: Send, sessions: LoginSessions, session: LoginSession, *, kind: str
) -> Receive:
    """Wrap `receive` of a request or websocket so that it ends with its session."""

    async def received() -> Message:
        try:
            async with asyncio.timeout(0 if session.is_over else sessions.left_s(session)) as limit:
                now_s = asyncio.get_running_loop().time
                with session.calling(lambda: None if limit.expired() else limit.reschedule(now_s())):
                    message = await receive()
            sessions.use(session)
        except TimeoutError:
            if kind == "http":
                return {"type": "http.disconnect"}
            # The peer may have disconnected meanwhile.
            with suppress(RuntimeError, OSError):
                await send({"type": "websocket.close", "code": 1008, "reason": "logged out"})
            return {"type": "websocket.disconnect", "code": 1008, "reason": "logged out"}
        return message

    return received


def _bearer(headers: Mapping[str, str]) -> str:
    scheme, _, token = headers.get("authorization", "").partition(" ")
    return token.strip() if scheme.lower() == "bearer" else ""


def _not_logged_in() -> RequestRefusal:
    return RequestRefusal(
        status=401,
        message="not logged in: open the address that `flexcell login` prints",
        headers={"www-authenticate": "Bearer"},
    )


@dataclass(frozen=True, kw_only=True)
class PolicyOrigins:
    """Sources of a content security policy: the page, its 3D view, and further origins for connections."""

    pages: Sequence[str] = ()
    views: Sequence[str] = ()
    connect_sources: Sequence[str] = ()

    @classmethod
    def beside(cls, host: str, view_port: int | None, connect_sources: Sequence[str]) -> Self:
        """Return the origins for the page at `host`, which includes the port; the 3D view has the same host name."""
        # A content security policy cannot express IPv6 addresses.
        named = f"*:{host.rpartition(':')[2]}" if host.startswith("[") else host
        views = () if view_port is None else (f"http://{_at(named, view_port)}",)
        return cls(pages=(f"http://{named}",), views=views, connect_sources=tuple(connect_sources))


def response_headers(path: str, origins: PolicyOrigins | None = None) -> dict[str, str]:
    """Return the headers of every response under `path`."""
    of = origins or PolicyOrigins()
    is_view = path.startswith(VIEW_PATH)
    policy = (
        CELL_POLICY.format(pages=_listed(of.pages))
        if is_view
        else PAGE_POLICY.format(sources=_listed(of.connect_sources), views=_listed(of.views))
    )
    headers = {
        "content-security-policy": policy,
        "x-content-type-options": "nosniff",
        # With no-referrer, a browser sends `Origin: null` with a form, and the login would be refused.
        "referrer-policy": "same-origin" if path == "/login" else "no-referrer",
        "cross-origin-opener-policy": "same-origin",
        "cross-origin-resource-policy": "same-origin",
    }
    if is_view:
        # Otherwise browsers may run the view in the process of the page around it, as both belong to one site.
        headers["origin-agent-cluster"] = "?1"
    if not path.startswith("/assets/"):
        headers["cache-control"] = "no-store"
    return headers


def _at(host: str, port: int) -> str:
    """Return a host with its port replaced."""
    return f"{host.rpartition(':')[0]}:{port}"


def _listed(sources: Sequence[str]) -> str:
    return "".join(f" {source}" for source in sources)


def _with_headers(headers: Mapping[str, str], send: Send) -> Send:
    extra = [(k.encode(), v.encode()) for k, v in headers.items()]

    async def send_with_headers(message: Message) -> None:
        if message["type"] == "http.response.start":
            message["headers"] = [*message.get("headers", []), *extra]
        await send(message)

    return send_with_headers


async def _answer(headers: Mapping[str, str], send: Send, refusal: RequestRefusal) -> None:
    body = refusal_body(refusal.message)
    every = {
        "content-type": "application/json",
        "content-length": str(len(body)),
        **headers,
        **refusal.headers,
    }
    await send(
        {
            "type": "http.response.start",
            "status": refusal.status,
            "headers": [(k.encode(), v.encode()) for k, v in every.items()],
        }
    )
    await send({"type": "http.response.body", "body": body})
