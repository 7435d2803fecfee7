"""Connections with timeouts for their peers; connections that wait for a peer can be closed for new ones."""

from __future__ import annotations

import asyncio
import sys
from collections import OrderedDict
from http import HTTPStatus
from typing import Any

import h11
from uvicorn._types import ASGISendEvent
from uvicorn.config import Config
from uvicorn.protocols.http.h11_impl import H11Protocol
from uvicorn.protocols.websockets.websockets_sansio_impl import WebSocketsSansIOProtocol
from uvicorn.server import ServerState

from editor_web.transport import request_limits as bodies

HEAD_LIMIT_S = 10.0
WRITE_LIMIT_S = 30.0
"""A peer that does not read a response for longer is disconnected."""
BODY_GRACE_S = 1.0
_CLOSE_GRACE_S = 1.0
_LINGER_S = 1.0
# A socket that is closed on unread data resets the connection, and the peer may lose the answer that it was sent.
_BAD_HANDSHAKE = b"HTTP/1.1 400 Bad Request\r\nConnection: close\r\nContent-Length: 0\r\n\r\n"
_INVALID_TEXT = 1007
_HEAD_TOO_LARGE = 431
_NO_HTTP = "this is no valid HTTP request"


class PendingConnections:
    """The connections that wait for a request or the rest of one; the longest waiting first."""

    def __init__(self) -> None:
        self._waiting: OrderedDict[TimedConnection, None] = OrderedDict()

    def add(self, connection: TimedConnection) -> None:
        """Add a connection that waits for its peer; no effect if it is present."""
        self._waiting.setdefault(connection)

    def discard(self, connection: TimedConnection) -> None:
        """Remove a connection that no longer waits."""
        self._waiting.pop(connection, None)

    def close_longest(self) -> bool:
        """Close the connection that has waited longest; return False if none waits."""
        if not self._waiting:
            return False
        connection, _ = self._waiting.popitem(last=False)
        connection.transport.abort()
        return True


class TimedConnection(H11Protocol):
    """uvicorn's HTTP connection with timeouts; uvicorn itself waits forever for the rest of a request.

    The head must arrive within `HEAD_LIMIT_S`, the body within `bodies.BODY_LIMIT_S` after it, even if no route reads
    it: a refused request has a body too.
    """

    _timer: asyncio.TimerHandle | None = None
    _write_timer: asyncio.TimerHandle | None = None
    _timed_state: type[h11.IDLE | h11.SEND_BODY] | None = None
    _is_refused = False

    def __init__(
        self,
        config: Config,
        server_state: ServerState,
        app_state: dict[str, Any],
        _loop: asyncio.AbstractEventLoop | None = None,
        *,
        waiting: PendingConnections,
    ) -> None:
        super().__init__(config, server_state, app_state, _loop)
        self._waiting = waiting

    def connection_made(self, transport: asyncio.BaseTransport) -> None:  # pyright: ignore[reportIncompatibleMethodOverride]
        """Start waiting for the first request."""
        if isinstance(transport, asyncio.Transport):
            super().connection_made(transport)
        self._follow()

    def data_received(self, data: bytes) -> None:
        """Process received data; each part of a request is timed from its first byte on."""
        if self._is_refused:
            return
        super().data_received(data)
        self._follow()

    def on_response_complete(self) -> None:
        """Wait for the next request, or for the rest of one that was answered before it was read completely."""
        super().on_response_complete()
        self._follow()

    def send_400_response(self, msg: str) -> None:
        """Refuse what is no request in JSON, as all refusals are; an address or a header that is too long with 431."""
        error = sys.exception()
        is_too_large = isinstance(error, h11.RemoteProtocolError) and error.error_status_hint == _HEAD_TOO_LARGE
        status, message = (_HEAD_TOO_LARGE, bodies.HEAD_TOO_LARGE) if is_too_large else (400, _NO_HTTP)
        body = bodies.refusal_body(message)
        headers = [("content-type", "application/json"), ("content-length", str(len(body))), ("connection", "close")]
        answer = (
            h11.Response(status_code=status, headers=headers, reason=HTTPStatus(status).phrase),
            h11.Data(data=body),
            h11.EndOfMessage(),
        )
        for event in answer:
            self.transport.write(self.conn.send(event) or b"")
        self._is_refused = True
        self.transport.write_eof()
        self.loop.call_later(_LINGER_S, self.transport.close)

    def handle_websocket_upgrade(self, event: h11.Request) -> None:
        """Hand the transport over to a websocket."""
        super().handle_websocket_upgrade(event)
        self._release()

    def pause_writing(self) -> None:
        """Limit the wait for a peer that does not read."""
        super().pause_writing()
        self._waiting.add(self)
        self._write_timer = self.loop.call_later(WRITE_LIMIT_S, self.transport.abort)

    def resume_writing(self) -> None:
        """Resume the response."""
        self._stop_write_timer()
        super().resume_writing()
        self._follow()

    def connection_lost(self, exc: Exception | None) -> None:
        """Stop waiting."""
        self._release()
        self._stop_write_timer()
        super().connection_lost(exc)

    def _follow(self) -> None:
        """Start or stop the timer for the data that the peer has to send now."""
        if self.transport.get_protocol() is not self or self.transport.is_closing():
            self._release()
            return
        state = self.conn.their_state
        owed = state if state in (h11.IDLE, h11.SEND_BODY) else None
        if owed is None and self._is_answering:
            self._waiting.discard(self)
        else:
            self._waiting.add(self)
        if owed is not self._timed_state:
            self._stop_timer()
            self._timed_state = owed
            if owed is not None:
                limit_s = HEAD_LIMIT_S if owed is h11.IDLE else bodies.BODY_LIMIT_S + BODY_GRACE_S
                self._timer = self.loop.call_later(limit_s, self.transport.close)

    @property
    def _is_answering(self) -> bool:
        return self.cycle is not None and not self.cycle.response_complete  # pyright: ignore[reportUnnecessaryComparison] # None before the first

    def _release(self) -> None:
        self._waiting.discard(self)
        self._stop_timer()
        self._timed_state = None

    def _stop_timer(self) -> None:
        if self._timer is not None:
            self._timer.cancel()
            self._timer = None

    def _stop_write_timer(self) -> None:
        if self._write_timer is not None:
            self._write_timer.cancel()
            self._write_timer = None


class PageWebSocket(WebSocketsSansIOProtocol):
    """uvicorn's websocket with timeouts; uvicorn itself waits forever for a peer, and logs every protocol error."""

    _abort: asyncio.TimerHandle | None = None

    def send_receive_event_to_app(self) -> None:
        """Forward a message; text that is not UTF-8 ends the connection."""
        if self.curr_msg_data_type == "text" and not self.close_sent:
            try:
                b"".join(self.frames).decode()
            except UnicodeDecodeError:
                self.frames = []
                self.conn.fail(_INVALID_TEXT, "text that is not UTF-8")
                self.handle_parser_exception()
                return
        super().send_receive_event_to_app()

    def data_received(self, data: bytes) -> None:
        """Process received data; uvicorn itself would wait forever after an invalid handshake."""
        super().data_received(data)
        if not self.handshake_initiated and self.conn.handshake_exc is not None:
            self.transport.write(_BAD_HANDSHAKE)
            self.transport.close()

    def handle_parser_exception(self) -> None:
        """Close once, with the code of the error."""
        if not self.close_sent:
            super().handle_parser_exception()
            self._abort_soon()

    def keepalive_timeout(self) -> None:
        """Close on a peer that does not answer pings, even if it does not take the close frame."""
        super().keepalive_timeout()
        self._abort_soon()

    async def send(self, message: ASGISendEvent) -> None:
        """Send a message; the connection is aborted if the peer does not answer a close frame."""
        await super().send(message)
        if self.close_timer is not None:
            self._abort_soon(self.close_timeout)

    def pause_writing(self) -> None:
        """Limit the wait for a peer that does not read: its pings and its close would wait as well."""
        super().pause_writing()
        self._abort_soon(WRITE_LIMIT_S)

    def resume_writing(self) -> None:
        """Resume sending."""
        self._stop_abort()
        super().resume_writing()

    def connection_lost(self, exc: Exception | None) -> None:
        """Stop waiting."""
        self._stop_abort()
        super().connection_lost(exc)

    def _abort_soon(self, after_s: float = 0.0) -> None:
        # asyncio closes a transport only after the peer has read all written data.
        self._stop_abort()
        self._abort = self.loop.call_later(after_s + _CLOSE_GRACE_S, self.transport.abort)

    def _stop_abort(self) -> None:
        if self._abort is not None:
            self._abort.cancel()
            self._abort = None
