"""The dashboard as a running server: binds loopback, prints nothing, provides its login address."""

from __future__ import annotations

import asyncio
import socket
from collections.abc import AsyncGenerator, Callable, Generator, Sequence
from contextlib import asynccontextmanager, contextmanager
from dataclasses import dataclass, field
from pathlib import Path

import uvicorn

from editor_web.app import STATIC, new_app
from editor_web.cell_view import CellView
from editor_web.security.authentication import OPERATOR, Role, load_access_tokens
from editor_web.security.login_sessions import LoginSessions
from editor_web.transport.acceptor import Acceptor
from editor_web.transport.capacity import COMMAND_RESERVE, connection_limit, raise_descriptor_limit
from editor_web.transport.log_throttle import throttle_library_logs
from editor_web.transport.request_limits import MAX_HEAD_BYTES
from editor_web.transport.timed_connection import PageWebSocket, PendingConnections, TimedConnection
from engine.errors import FlexcellError
from engine.host.loopback import bound_socket, host_in_url
from engine.project import Session
from engine.stop import StopRelay

STOP_LIMIT_S = 3
PING_S = 5.0
SILENCE_S = 12.0
"""A websocket that does not answer protocol pings for longer is closed."""


@dataclass(frozen=True, kw_only=True)
class Dashboard:
    """A running server: `url` is the page, `token` the operator token, `view_port` the 3D view's port if it has one."""

    url: str
    token: str = field(repr=False)
    port: int
    view_port: int | None
    sessions: LoginSessions = field(repr=False)

    def new_login_url(self, role: Role = OPERATOR) -> str:
        """Return a single-use login address for a browser."""
        return f"{self.url}login?t={self.sessions.new_link(role)}"


class _Server(uvicorn.Server):
    """uvicorn without signal handlers, as the owner of the cell handles Ctrl-C, and with a custom acceptor."""

    def __init__(self, config: uvicorn.Config, listeners: Sequence[socket.socket], *, limit: int) -> None:
        super().__init__(config)
        self._listeners = listeners
        self._limit = limit

    @contextmanager
    def capture_signals(self) -> Generator[None, None, None]:
        """Keep the process's signal handlers."""
        yield

    async def startup(self, sockets: list[socket.socket] | None = None) -> None:
        """Start the application, then accept connections."""
        await self.lifespan.startup()
        if self.lifespan.should_exit:
            raise FlexcellError("the dashboard ended while it was starting", hint="see the log above")
        waiting = PendingConnections()
        acceptors = [
            Acceptor(
                listener,
                new_protocol=lambda: TimedConnection(
                    self.config, self.server_state, self.lifespan.state, waiting=waiting
                ),
                limit=self._limit,
                count=lambda: len(self.server_state.connections),
                waiting=waiting,
            )
            for listener in self._listeners
        ]
        for acceptor in acceptors:
            acceptor.open()
        self.servers = acceptors  # pyright: ignore[reportAttributeAccessIssue] # closed and waited for like those
        self.started = True


@asynccontextmanager
async def dashboard(
    backend: Session,
    *,
    token_file: Path,
    host: str = "127.0.0.1",
    port: int = 0,
    view_port: int = 0,
    cell_view: bool = True,
    shadows: bool = True,
    static: Path = STATIC,
    relay: StopRelay | None = None,
    max_connections: int | None = None,
) -> AsyncGenerator[Dashboard]:
    """Serve the page while the block runs.

    Args:
        backend: The engine.
        token_file: File of the access tokens; created if missing. Sessions are stored beside it.
        host: A loopback address or name.
        port: TCP port; 0 chooses a free one.
        view_port: TCP port of the 3D view's own origin; 0 chooses a free one.
        cell_view: Whether to draw the cell in 3D.
        shadows: Whether the 3D view casts shadows.
        static: Folder of the built page.
        relay: Receives STOP from the page if this server does not respond.
        max_connections: Maximum number of connections; by default as many as the open-file limit allows.

    Raises:
        FlexcellError: the host is not loopback, the port is in use, or the token file cannot be used.
    """
    access = load_access_tokens(token_file)
    sessions = LoginSessions(file=token_file.with_name("sessions"), tokens=access.fingerprint())
    sessions.load()
    listeners = [bound_socket(host, port, option="--port")]
    if cell_view:
        try:
            listeners.append(bound_socket(host, view_port, option="--view-port"))
        except FlexcellError:
            listeners[0].close()
            raise
    bound, *others = (int(each.getsockname()[1]) for each in listeners)
    view = others[0] if others else None
    hosts = frozenset(f"{name}:{bound}" for name in (host_in_url(host), "127.0.0.1", "localhost", "[::1]"))
    if relay is not None:
        relay.allow_origins(f"http://{name}" for name in hosts)
    limit = connection_limit() if max_connections is None else max_connections
    app = new_app(
        backend,
        access=access,
        hosts=hosts,
        port=bound,
        cell_view=CellView(backend, shadows=shadows) if cell_view else None,
        static=static,
        sessions=sessions,
        capacity=limit - COMMAND_RESERVE,
        stop=relay.endpoint if relay is not None else None,
        view_port=view,
    )
    config = uvicorn.Config(
        app,
        log_config=None,
        access_log=False,
        server_header=False,
        h11_max_incomplete_event_size=MAX_HEAD_BYTES,
        ws=PageWebSocket,
        ws_max_size=1_000_000,
        ws_per_message_deflate=False,
        ws_ping_interval=PING_S,
        ws_ping_timeout=SILENCE_S - PING_S,
        timeout_graceful_shutdown=STOP_LIMIT_S,
    )
    server = _Server(config, listeners, limit=limit)
    with throttle_library_logs():
        serving = asyncio.create_task(server.serve(), name="dashboard")
        try:
            await _started(server, serving)
            yield Dashboard(
                url=f"http://{host_in_url(host)}:{bound}/",
                token=access.operator,
                port=bound,
                view_port=view,
                sessions=sessions,
            )
        finally:
            server.should_exit = True
            await serving
            for listener in listeners:
                listener.close()
            sessions.save()


async def serve(
    backend: Session,
    *,
    token_file: Path,
    host: str = "127.0.0.1",
    port: int = 0,
    view_port: int = 0,
    relay: StopRelay | None = None,
    on_ready: Callable[[Dashboard], None],
) -> None:
    """Serve the page until cancelled; `on_ready` is called with the dashboard when it is ready."""
    raise_descriptor_limit()
    async with dashboard(
        backend, token_file=token_file, host=host, port=port, view_port=view_port, relay=relay
    ) as running:
        on_ready(running)
        await asyncio.Event().wait()


async def _started(server: uvicorn.Server, serving: asyncio.Task[None]) -> None:
    # uvicorn provides no event for this, only a flag.
    while not server.started:
        if serving.done():
            await serving
            raise FlexcellError("the dashboard ended while it was starting", hint="see the log above")
        await asyncio.sleep(0.005)
