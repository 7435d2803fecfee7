"""The gate in front of every request: host, origin, session, role and response headers.

A plain ASGI middleware, because it must also stand before websockets: browsers do not apply the
same-origin policy to them.
"""

from __future__ import annotations

import json
import logging
from collections.abc import Mapping
from dataclasses import dataclass
from http.cookies import CookieError, SimpleCookie
from urllib.parse import urlsplit

from starlette.types import ASGIApp, Message, Receive, Scope, Send

from editor_web.access import OPERATOR, Access, AttemptLimit
from editor_web.bodies import TOO_LARGE, bounded, told_too_large
from engine.stop import StopEndpoint

PAGE_POLICY = (
    "default-src 'self'; style-src 'self' 'unsafe-inline'; img-src 'self' data:; font-src 'self' data:; "
    "worker-src 'self' blob:; connect-src 'self'; frame-src 'self'; frame-ancestors 'self'; object-src 'none'; "
    "base-uri 'none'; form-action 'self'"
)
# viser's page is one file with inlined scripts and wasm; it gets what it needs, under its own path only.
CELL_POLICY = (
    "default-src 'self'; script-src 'self' 'unsafe-inline' 'unsafe-eval' blob:; style-src 'self' 'unsafe-inline'; "
    "img-src 'self' data: blob:; font-src 'self' data:; worker-src 'self' blob: data:; "
    "connect-src 'self' data: blob:; frame-ancestors 'self'; object-src 'none'; base-uri 'none'"
)
SAFE_METHODS = frozenset({"GET", "HEAD", "OPTIONS"})
OPEN_PATHS = frozenset({"/login", "/favicon.svg"})

_audit = logging.getLogger("flexcell.audit")


@dataclass(frozen=True, kw_only=True)
class Refusal:
    """Why a request is turned away, and how."""

    status: int
    message: str
    headers: Mapping[str, str]


def cookie_name(port: int) -> str:
    """Return the session cookie's name: browsers share cookies between the ports of one host."""
    return f"flexcell_session_{port}"


class Gate:
    """Admit a request to `app` when host, origin and session are right.

    Args:
        app: The application behind the gate.
        access: The tokens.
        limit: Counts wrong bearer tokens, shared with the log-in page.
        hosts: Values of the Host header to answer to, with port, in lower case.
        port: Our own port, for the cookie's name.
        stop: Where pages may send STOP, besides here.
    """

    def __init__(
        self,
        app: ASGIApp,
        *,
        access: Access,
        limit: AttemptLimit,
        hosts: frozenset[str],
        port: int,
        stop: StopEndpoint | None = None,
    ) -> None:
        self._app = app
        self._access = access
        self._limit = limit
        self._hosts = hosts
        self._cookie = cookie_name(port)
        self._connects = (_origin(stop.url),) if stop is not None else ()

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Serve or refuse one request or websocket."""
        if scope["type"] == "lifespan":
            await self._app(scope, receive, send)
            return
        headers = {name.decode("latin-1"): value.decode("latin-1") for name, value in scope["headers"]}
        refusal = self._refusal(scope, headers)
        if refusal is None and scope["type"] == "websocket":
            await self._app(scope, receive, send)
        elif refusal is None:
            await self._app(scope, bounded(receive), _with_headers(scope, send, self._connects))
        elif scope["type"] == "websocket":
            await receive()
            await send({"type": "websocket.close", "code": 1008, "reason": refusal.message})
        else:
            await _answer(scope, send, refusal)

    def _refusal(self, scope: Scope, headers: Mapping[str, str]) -> Refusal | None:
        host = headers.get("host", "").lower()
        if host not in self._hosts:
            return _refuse(421, "this server does not answer to that host name")
        if told_too_large(headers):
            return _refuse(413, TOO_LARGE)
        origin = headers.get("origin")
        is_websocket = scope["type"] == "websocket"
        unsafe = is_websocket or scope["method"] not in SAFE_METHODS
        bearer = _bearer(headers)
        if unsafe:
            if origin is None and not bearer:
                return _refuse(403, "the Origin header is missing")
            if origin is not None and origin.lower() != f"http://{host}":
                return _refuse(403, "requests from other pages are refused")
            if headers.get("sec-fetch-site", "same-origin") not in ("same-origin", "none"):
                return _refuse(403, "requests from other sites are refused")
        if scope["path"] in OPEN_PATHS and not is_websocket:
            return None
        if bearer and self._limit.wait_s() > 0:
            return Refusal(
                status=429,
                message="too many wrong tokens",
                headers={"retry-after": str(int(self._limit.wait_s()) + 1)},
            )
        role = self._role(headers, bearer)
        if role is None:
            return self._not_logged_in(scope, headers)
        if unsafe and not is_websocket and role != OPERATOR:
            return _refuse(403, "a viewer may look only; log in with the operator token")
        if unsafe and not is_websocket:
            # The query is left out: it could carry a secret.
            _audit.info("%s %s by %s", scope["method"], scope["path"], role)
        scope.setdefault("state", {})["role"] = role
        return None

    def _role(self, headers: Mapping[str, str], bearer: str) -> str | None:
        if bearer:
            role = self._access.role_of_token(bearer)
            if role is None:
                self._limit.failed()
            return role
        try:
            cookie = SimpleCookie(headers.get("cookie", "")).get(self._cookie)
        except CookieError:
            return None
        return self._access.role_of_session(cookie.value) if cookie else None

    def _not_logged_in(self, scope: Scope, headers: Mapping[str, str]) -> Refusal:
        wants_page = scope["type"] == "http" and "text/html" in headers.get("accept", "") and scope["method"] == "GET"
        if wants_page:
            return Refusal(status=303, message="log in first", headers={"location": "/login"})
        return Refusal(
            status=401,
            message="not logged in: open the address that `flexcell serve` printed",
            headers={"www-authenticate": "Bearer"},
        )


def _bearer(headers: Mapping[str, str]) -> str:
    scheme, _, token = headers.get("authorization", "").partition(" ")
    return token.strip() if scheme.lower() == "bearer" else ""


def _refuse(status: int, message: str) -> Refusal:
    return Refusal(status=status, message=message, headers={})


def response_headers(path: str, *, connects: tuple[str, ...] = ()) -> dict[str, str]:
    """Return the headers that every answer under `path` carries; `connects` are origins that a page may talk to."""
    page_policy = PAGE_POLICY.replace("connect-src 'self'", " ".join(("connect-src 'self'", *connects)))
    headers = {
        "content-security-policy": CELL_POLICY if path.startswith("/cell/") else page_policy,
        "x-content-type-options": "nosniff",
        # Under no-referrer a browser sends `Origin: null` with a form, and the log-in's would be refused.
        "referrer-policy": "same-origin" if path == "/login" else "no-referrer",
        "cross-origin-opener-policy": "same-origin",
        "cross-origin-resource-policy": "same-origin",
    }
    if not path.startswith("/assets/"):
        headers["cache-control"] = "no-store"
    return headers


def _origin(url: str) -> str:
    parts = urlsplit(url)
    return f"{parts.scheme}://{parts.netloc}"


def _with_headers(scope: Scope, send: Send, connects: tuple[str, ...]) -> Send:
    extra = [(k.encode(), v.encode()) for k, v in response_headers(scope["path"], connects=connects).items()]

    async def send_with_headers(message: Message) -> None:
        if message["type"] == "http.response.start":
            message["headers"] = [*message.get("headers", []), *extra]
        await send(message)

    return send_with_headers


async def _answer(scope: Scope, send: Send, refusal: Refusal) -> None:
    body = json.dumps({"message": refusal.message, "where": "", "hint": ""}).encode()
    headers = {"content-type": "application/json", **response_headers(scope["path"]), **refusal.headers}
    await send(
        {
            "type": "http.response.start",
            "status": refusal.status,
            "headers": [(k.encode(), v.encode()) for k, v in headers.items()],
        }
    )
    await send({"type": "http.response.body", "body": body})
