"""viser behind a lock: its page without its own panel, its port only for those who know the key.

viser runs its own thread and port and asks nobody for a password. It is bound to loopback, and demands a
secret header that only our proxy sends (`routes/cell.py`). The same header tells which page a connection is of.
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
"""The page that a connection of viser belongs to; set in all that is done for that connection."""
ROLE: ContextVar[str] = ContextVar("cell_role", default="")
"""What whoever looks at that page may do: a role of `editor_web.security.authentication`."""
_HIDE_PANEL = (
    b"<style>[data-testid=floating-panel],[data-floating-window],[data-dock-region],div:has([data-dock-root])~.mantine-Paper-root,"
    b".mantine-Notifications-root{display:none!important}</style></head>"
)
# What viser's reading of a message raises where it is none of viser's own.
_UNREADABLE = (AssertionError, AttributeError, KeyError, TypeError, ValueError, msgspec.DecodeError)
_UNSUPPORTED_DATA = 1003
_log = logging.getLogger("flexcell.cell_view")


def viser_page() -> bytes:
    """Return viser's one-file page with its own panel hidden, and with what tells the page around it of the mouse."""
    built = Path(viser.__file__).parent / "client" / "build" / "index.html"
    told = b"<script>" + Path(__file__).with_name("frame_events.js").read_bytes() + b"</script>"
    return built.read_bytes().replace(b"</head>", told + _HIDE_PANEL, 1)


def new_viser_server(key: str) -> viser.ViserServer:
    """Start viser on a loopback port that demands `key`; takes some 20 ms."""
    # viser greets on stdout, which belongs to the command line's own output; nobody else uses rich's global console.
    rich.reconfigure(quiet=True)
    with _locked(key):
        # 127.0.0.1 can always be bound; viser would wait for ever on an address that cannot.
        server = viser.ViserServer(host="127.0.0.1", port=0, verbose=False)
    # Any connected page may ask viser to publish itself through a public tunnel: never.
    server.request_share_url = _no_tunnel
    server.gui.configure_theme(show_logo=False, show_share_button=False)
    return server


def _no_tunnel(verbose: bool = True) -> str | None:
    del verbose
    return None


@contextmanager
def _locked(key: str) -> Generator[None]:
    """Make the server that viser opens inside demand our header; viser has no option for it."""
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
