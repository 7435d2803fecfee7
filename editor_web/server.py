"""The dashboard as a running server: binds loopback, prints nothing, tells its log-in address."""

from __future__ import annotations

import asyncio
import ipaddress
import socket
from collections.abc import AsyncGenerator, Callable, Generator
from contextlib import asynccontextmanager, contextmanager
from dataclasses import dataclass
from pathlib import Path

import uvicorn

from editor_web.access import load_access
from editor_web.app import STATIC, new_app
from editor_web.backend import Backend
from editor_web.cell_view import CellView
from editor_web.connection import TimedConnection
from engine.errors import FlexcellError
from engine.stop import StopRelay

STOP_LIMIT_S = 3


@dataclass(frozen=True, kw_only=True)
class Dashboard:
    """A running server: `url` is the page, `login_url` opens it with the operator's token, `token`."""

    url: str
    login_url: str
    token: str
    port: int


class _Server(uvicorn.Server):
    """uvicorn without its signal handlers: Ctrl-C belongs to whoever runs the cell."""

    @contextmanager
    def capture_signals(self) -> Generator[None, None, None]:
        """Leave the process's signal handlers alone."""
        yield


@asynccontextmanager
async def dashboard(
    backend: Backend,
    *,
    token_file: Path,
    host: str = "127.0.0.1",
    port: int = 0,
    cell_view: bool = True,
    shadows: bool = True,
    static: Path = STATIC,
    relay: StopRelay | None = None,
) -> AsyncGenerator[Dashboard]:
    """Serve the page while the block runs.

    Args:
        backend: The engine.
        token_file: Where the log-in tokens are kept; made when missing.
        host: A loopback address or name.
        port: TCP port; 0 takes a free one.
        cell_view: Whether to draw the cell in 3D.
        shadows: Whether the 3D view casts shadows.
        static: Folder of the built page.
        relay: Takes STOP from the page where this server does not answer.

    Raises:
        FlexcellError: The host is not loopback, the port is taken, or the token file cannot be used.
    """
    access = load_access(token_file)
    listener = _bind(host, port)
    bound = int(listener.getsockname()[1])
    hosts = frozenset(f"{name}:{bound}" for name in (_in_url(host), "127.0.0.1", "localhost", "[::1]"))
    if relay is not None:
        relay.allow_origins(f"http://{name}" for name in hosts)
    app = new_app(
        backend,
        access=access,
        hosts=hosts,
        port=bound,
        cell_view=CellView(backend, shadows=shadows) if cell_view else None,
        static=static,
        stop=relay.endpoint if relay is not None else None,
    )
    server = _Server(
        uvicorn.Config(
            app,
            log_config=None,
            access_log=False,
            server_header=False,
            http=TimedConnection,
            ws="websockets-sansio",
            ws_max_size=1_000_000,
            ws_per_message_deflate=False,
            timeout_graceful_shutdown=STOP_LIMIT_S,
        )
    )
    serving = asyncio.create_task(server.serve(sockets=[listener]), name="dashboard")
    try:
        await _started(server, serving)
        url = f"http://{_in_url(host)}:{bound}/"
        yield Dashboard(url=url, login_url=f"{url}login?t={access.operator}", token=access.operator, port=bound)
    finally:
        server.should_exit = True
        await serving
        listener.close()


async def serve(
    backend: Backend,
    *,
    token_file: Path,
    host: str = "127.0.0.1",
    port: int = 0,
    relay: StopRelay | None = None,
    on_ready: Callable[[Dashboard], None],
) -> None:
    """Serve the page until cancelled; `on_ready` is told the address once it answers."""
    async with dashboard(backend, token_file=token_file, host=host, port=port, relay=relay) as running:
        on_ready(running)
        await asyncio.Event().wait()


async def _started(server: uvicorn.Server, serving: asyncio.Task[None]) -> None:
    # uvicorn offers no event for this; its own flag is all there is.
    while not server.started:
        if serving.done():
            await serving
            raise FlexcellError("the dashboard ended while it was starting", hint="see the log above")
        await asyncio.sleep(0.005)


def _in_url(host: str) -> str:
    return f"[{host}]" if ":" in host else host.lower()


def _is_loopback(host: str) -> bool:
    try:
        return ipaddress.ip_address(host).is_loopback
    except ValueError:
        return host.lower() == "localhost"


def _bind(host: str, port: int) -> socket.socket:
    if not _is_loopback(host):
        raise FlexcellError(
            "the dashboard listens on this machine only",
            where=host,
            hint="use 127.0.0.1, and from elsewhere an SSH tunnel: ssh -L 8642:127.0.0.1:8642 <machine>",
        )
    family = socket.AF_INET6 if ":" in host else socket.AF_INET
    listener = socket.socket(family, socket.SOCK_STREAM)
    try:
        listener.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        listener.bind((host, port))
    except OSError as error:
        listener.close()
        raise FlexcellError(
            f"cannot listen on {host}:{port}: {error.strerror or error}",
            where="--port",
            hint="another server may be running; choose another --port",
        ) from error
    return listener
