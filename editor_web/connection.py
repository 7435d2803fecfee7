"""An HTTP connection on which the head of each request comes in time, or which is closed."""

from __future__ import annotations

import asyncio

import h11
from uvicorn.protocols.http.h11_impl import H11Protocol

HEAD_LIMIT_S = 10.0


class TimedConnection(H11Protocol):
    """uvicorn's connection, which itself would wait for the rest of a head for ever."""

    _head_timer: asyncio.TimerHandle | None = None

    def connection_made(self, transport: asyncio.BaseTransport) -> None:  # pyright: ignore[reportIncompatibleMethodOverride]
        """Begin to wait for the first request."""
        if isinstance(transport, asyncio.Transport):
            super().connection_made(transport)
        self._time_head()

    def data_received(self, data: bytes) -> None:
        """Take what came; a head is timed from its first byte on."""
        super().data_received(data)
        self._time_head()

    def connection_lost(self, exc: Exception | None) -> None:
        """Stop waiting."""
        self._stop_timer()
        super().connection_lost(exc)

    def _time_head(self) -> None:
        if self.conn.their_state is not h11.IDLE:
            self._stop_timer()
        elif self._head_timer is None:
            self._head_timer = self.loop.call_later(HEAD_LIMIT_S, self._too_slow)

    def _too_slow(self) -> None:
        self._head_timer = None
        # A websocket has taken the transport over, or the head has come meanwhile.
        if self.transport.get_protocol() is self and self.conn.their_state is h11.IDLE:
            self.transport.close()

    def _stop_timer(self) -> None:
        if self._head_timer is not None:
            self._head_timer.cancel()
            self._head_timer = None
