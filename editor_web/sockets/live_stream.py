"""The websocket `/api/v1/live`: receives `WatchRun`, sends snapshots and deltas, at most 20 per second."""

from __future__ import annotations

import asyncio
import logging
import time

import msgspec
from fastapi import APIRouter, WebSocket

from editor_web.cell_view import CellView
from editor_web.live.hub import LiveClient
from editor_web.live.live_frames import (
    PROTOCOL_VERSION,
    Hello,
    LookAt,
    OperateRun,
    Ping,
    Request,
    ScrubPath,
    ShowLayers,
    WatchRun,
)
from editor_web.live.presence import PresenceRoster, ShowPresence
from editor_web.routes.services import role_of, services_of
from editor_web.security.authentication import OPERATOR
from editor_web.sockets.page_socket import PageDisconnected, disconnect_page, read_message, send_message
from engine.errors import FlexcellError
from engine.project import RunOperator, Session

router = APIRouter()
PERIOD_S = 0.05
PING_S = 5.0
SILENCE_S = 12.0
"""A page answers each ping; one that is silent for longer counts as disconnected."""
_decoder: msgspec.json.Decoder[Request] = msgspec.json.Decoder(Request)
_log = logging.getLogger("flexcell.live")


@router.websocket("/api/v1/live")
async def live(socket: WebSocket) -> None:
    """Serve one page until it disconnects, is too slow, or is silent for `SILENCE_S`."""
    services = services_of(socket)
    await socket.accept()
    client = services.hub.join()
    role = role_of(socket)
    operator = _Operator(services.backend, role, services.hub.presence, client.page)
    scrub = _Scrub(services.cell_view)
    hello = Hello(version=PROTOCOL_VERSION, epoch=services.hub.epoch, role=role, server_time_s=time.time())
    try:
        await send_message(socket, hello)
        async with asyncio.TaskGroup() as tasks:
            tasks.create_task(_receive(socket, client, operator, services.cell_view, scrub), name="live-receive")
            tasks.create_task(_stream(socket, client), name="live-stream")
    except* PageDisconnected:
        pass
    finally:
        operator.lose()
        scrub.end()
        services.hub.leave(client)


class _Operator:
    """The run that the page of one connection operates."""

    def __init__(self, session: Session, role: str, presence: PresenceRoster, page: int) -> None:
        self._session = session
        self._role = role
        self._presence = presence
        self._page = page
        self._attached: RunOperator | None = None

    def operate(self, run_id: str) -> None:
        """Detach from the previous run; operate this run if it is active."""
        if self._attached is not None:
            self._attached.detach()
            self._attached = None
        if run_id and self._role == OPERATOR:
            try:
                self._attached = self._session.operate(run_id)
            except FlexcellError as error:
                # The run may have ended; its events and control state show the page whether it operates the run.
                _log.info("a page cannot operate a run: %s", error)
        self._presence.operate(self._page, self._role, self._attached.run_id if self._attached is not None else "")

    def show(self, shown: ShowPresence) -> None:
        """Let the other pages know what this one shows."""
        self._presence.show(self._page, self._role, shown)

    def lose(self) -> None:
        """Report the operator as lost after the end of the connection."""
        if self._attached is not None:
            self._attached.lose()
            self._attached = None


class _Scrub:
    """The planned path along which the page of one connection goes, one at a time."""

    def __init__(self, view: CellView | None) -> None:
        self._view = view
        self._shown: ScrubPath | None = None

    def go(self, request: ScrubPath) -> None:
        """Show the arm at this share of its path, and no other arm."""
        if self._shown is not None and (self._shown.page, self._shown.robot) != (request.page, request.robot):
            self.end()
        self._shown = request if request.share is not None else None
        if self._view is not None:
            self._view.scrub_path(request.page, request.robot, request.share)

    def end(self) -> None:
        """Show the path as every page sees it."""
        if self._shown is not None and self._view is not None:
            self._view.scrub_path(self._shown.page, self._shown.robot, None)
        self._shown = None


async def _receive(
    socket: WebSocket, client: LiveClient, operator: _Operator, view: CellView | None, scrub: _Scrub
) -> None:
    while True:
        try:
            async with asyncio.timeout(SILENCE_S):
                request = await read_message(socket, _decoder, expected="a watch or pong message")
        except TimeoutError as error:
            _log.warning("a page was silent for %.0f s and is disconnected", SILENCE_S)
            await disconnect_page(socket, "silent")
            raise PageDisconnected from error
        match request:
            case WatchRun():
                client.watch(request.run)
            case OperateRun():
                operator.operate(request.run)
            case ShowLayers():
                if view is not None:
                    view.show(request.page, frozenset(request.groups))
            case ShowPresence():
                operator.show(request)
            case ScrubPath():
                scrub.go(request)
            case LookAt():
                if view is not None:
                    view.look_at(request.page, request.names)
            case _:
                pass


async def _stream(socket: WebSocket, client: LiveClient) -> None:
    clock = asyncio.get_running_loop()
    ping_s = clock.time() + PING_S
    while True:
        if clock.time() >= ping_s:
            await send_message(socket, Ping(server_time_s=time.time()))
            ping_s = clock.time() + PING_S
        try:
            async with asyncio.timeout_at(ping_s):
                await client.dirty.wait()
        except TimeoutError:
            continue
        frame = client.frame()
        if frame is not None:
            await send_message(socket, frame)
        # Limit of the frame rate; changes in between are coalesced.
        await asyncio.sleep(PERIOD_S)
