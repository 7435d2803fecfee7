"""Rules for every request and websocket: well-formed, and from a page of this server."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

from starlette.types import Scope

SAFE_METHODS = frozenset({"GET", "HEAD", "OPTIONS"})
MAX_HEADERS = 64
MAX_HEADER_BYTES = 16_384
# Duplicates of these headers are ambiguous: parts of a server could use different ones.
_SINGLE = frozenset(
    {
        "authorization",
        "content-length",
        "content-type",
        "cookie",
        "host",
        "origin",
        "sec-fetch-site",
        "transfer-encoding",
    }
)
# Control characters, and replacements of bytes that are not UTF-8: no valid name contains them.
_ODD = re.compile(r"[\x00-\x1f\x7f-\x9f\ufffd\ud800-\udfff]")
_OWN_SITES = ("same-origin", "none")
VIEW_PATH = "/cell/"
_DATA_PATHS = ("/api/", VIEW_PATH)


@dataclass(frozen=True, kw_only=True)
class RequestRefusal:
    """The refusal of a request: status, message and headers."""

    status: int
    message: str
    headers: Mapping[str, str] = field(default_factory=dict[str, str])


def is_unsafe(scope: Scope) -> bool:
    """Return whether a request may change something: a websocket, or any method that is not read-only."""
    return scope["type"] == "websocket" or scope["method"] not in SAFE_METHODS


def refuse_malformed(scope: Scope) -> RequestRefusal | None:
    """Refuse a request with too many headers, a duplicate of a single header, or invalid characters in its address."""
    headers: Sequence[tuple[bytes, bytes]] = scope["headers"]
    if len(headers) > MAX_HEADERS or sum(len(name) + len(value) for name, value in headers) > MAX_HEADER_BYTES:
        return RequestRefusal(
            status=431, message=f"a request may have at most {MAX_HEADERS} headers, {MAX_HEADER_BYTES} bytes in total"
        )
    counts = Counter(name.decode("latin-1").lower() for name, _ in headers)
    twice = sorted(name for name in _SINGLE if counts[name] > 1)
    if twice:
        return RequestRefusal(status=400, message=f"the header {twice[0]} occurs more than once")
    if _ODD.search(scope["path"]):
        return RequestRefusal(
            status=400, message="the address contains control characters, or bytes that are not UTF-8"
        )
    return None


def refuse_cross_site(
    scope: Scope, headers: Mapping[str, str], *, has_token: bool, is_framed: bool = False
) -> RequestRefusal | None:
    """Refuse requests that a page of another host, port or site makes a browser send.

    A page of another port of this machine counts as another site, because browsers share the cookie between ports.
    The 3D view (`is_framed`) is opened by this server's page, on another port; its content security policy prevents
    others from framing it.
    """
    origin = headers.get("origin")
    if origin is None and is_unsafe(scope) and not has_token:
        return RequestRefusal(status=403, message="the Origin header is missing")
    if origin is not None and origin.lower() != f"http://{headers.get('host', '').lower()}":
        return RequestRefusal(status=403, message="requests from other pages are refused")
    if headers.get("sec-fetch-site", "none") not in _OWN_SITES and not (
        _opens_page(scope, headers) or (is_framed and _opens_frame(scope, headers))
    ):
        return RequestRefusal(status=403, message="requests from other sites are refused")
    return None


def refuse_unproven_cookie(scope: Scope, headers: Mapping[str, str]) -> RequestRefusal | None:
    """Refuse a request for data with only a cookie: the browser must declare that a page of this server sends it."""
    if "origin" in headers or "sec-fetch-site" in headers or not scope["path"].startswith(_DATA_PATHS):
        return None
    return RequestRefusal(
        status=403,
        message="the browser does not declare the requesting page: update it, or send the token instead of a cookie",
    )


def _opens_page(scope: Scope, headers: Mapping[str, str]) -> bool:
    """Return whether a request is a navigation to the page itself, which contains no data."""
    return _navigates(scope, headers, to="document") and not scope["path"].startswith(_DATA_PATHS)


def _opens_frame(scope: Scope, headers: Mapping[str, str]) -> bool:
    """Return whether a page of this machine opens the request in a frame."""
    return headers.get("sec-fetch-site") == "same-site" and _navigates(scope, headers, to="iframe")


def _navigates(scope: Scope, headers: Mapping[str, str], *, to: str) -> bool:
    is_navigation = headers.get("sec-fetch-mode") == "navigate" and headers.get("sec-fetch-dest") == to
    return is_navigation and not is_unsafe(scope)
