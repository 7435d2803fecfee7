"""viser with access control: its page without its own panel, its port only for clients with the key.

viser runs its own thread and port without authentication. It is bound to loopback, and requires a secret header that
only the proxy of this server sends (`sockets/cell_proxy.py`). A second header names the page of a connection.
"""

from __future__ import annotations

import hmac
import http
import logging
from collections.abc import Callable, Generator
from contextlib import contextmanager
from contextvars import ContextVar
from pathlib import Path
from typing import Any

import msgspec
import rich
import viser
import websockets.asyncio.server

KEY_HEADER = "X-Cell-Key"
PAGE_HEADER = "X-Cell-Page"
ROLE_HEADER = "X-Cell-Role"
PAGE: ContextVar[str] = ContextVar("cell_page", default="")
"""The page of a viser connection; set in the context of that connection."""
ROLE: ContextVar[str] = ContextVar("cell_role", default="")
"""The role of the page's session, see `editor_web.security.authentication`."""
_HIDE_PANEL = (
    b"<style>[data-testid=floating-panel],[data-floating-window],[data-dock-region],div:has([data-dock-root])~.mantine-Paper-root,"
    b".mantine-Notifications-root{display:none!important}</style></head>"
)
# Errors that viser raises while reading a message that is not its own.
_UNREADABLE = (AssertionError, AttributeError, KeyError, TypeError, ValueError, msgspec.DecodeError)
_UNSUPPORTED_DATA = 1003
_log = logging.getLogger("flexcell.cell_view")


def viser_page() -> bytes:
    """Return viser's one-file page with its panel hidden, and a script that reports mouse events to the parent page."""
    built = Path(viser.__file__).parent / "client" / "build" / "index.html"
    script = b"<script>" + Path(__file__).with_name("frame_events.js").read_bytes() + b"</script>"
    return built.read_bytes().replace(b"</head>", script + _HIDE_PANEL, 1)


def new_viser_server(key: str) -> viser.ViserServer:
    """Start viser on a loopback port that requires `key`; takes about 20 ms."""
    # viser prints to stdout, which is reserved for the command line's output; nothing else uses rich's global console.
    rich.reconfigure(quiet=True)
    with _locked(key):
        # 127.0.0.1 can always be bound; for an address that cannot, viser would wait without limit.
        server = viser.ViserServer(host="127.0.0.1", port=0, verbose=False)
    # Any connected page may request a public tunnel to viser; it is disabled.
    server.request_share_url = _no_tunnel
    server.gui.configure_theme(show_logo=False, show_share_button=False)
    return server


def _no_tunnel(verbose: bool = True) -> str | None:  # noqa: FBT001, FBT002 - viser's signature
    del verbose
    return None


@contextmanager
def _locked(key: str) -> Generator[None]:
    """Require the key header for the server that viser opens in this context; viser has no option for it."""
    original: Callable[..., Any] = websockets.asyncio.server.serve

    def serve(handler: Callable[..., Any], *args: Any, **options: Any) -> Any:
        inner: Callable[..., Any] | None = options.get("process_request")

        def checked(connection: Any, request: Any) -> Any:
            given = request.headers.get(KEY_HEADER, "")
            if not hmac.compare_digest(given.encode(), key.encode()):
                return connection.respond(http.HTTPStatus.FORBIDDEN, "open the cell view through the dashboard\n")
            return inner(connection, request) if inner else None

        async def named(connection: Any) -> None:
            PAGE.set(connection.request.headers.get(PAGE_HEADER, ""))
            ROLE.set(connection.request.headers.get(ROLE_HEADER, ""))
            try:
                await handler(connection)
            except _UNREADABLE as error:
                _log.warning("a page sent an unreadable message to the 3D view; its connection was closed: %r", error)
                await connection.close(_UNSUPPORTED_DATA, "not understood")

        return original(named, *args, **{**options, "process_request": checked})

    websockets.asyncio.server.serve = serve  # pyright: ignore[reportAttributeAccessIssue] # viser looks it up there
    try:
        yield
    finally:
        websockets.asyncio.server.serve = original  # pyright: ignore[reportAttributeAccessIssue] # as above
