"""The side channel of an emulator: one JSON object a line, on a port of its own, for faults and the true state.

`{"do": "freeze"}` is answered with `{"ok": true}`, `{"do": "state"}` with the state, what is not understood with
`{"error": …}`.
"""

from __future__ import annotations

import asyncio
from collections.abc import Awaitable, Callable, Mapping

import msgspec

Request = Mapping[str, object]
Handler = Callable[[Request], Awaitable[Mapping[str, object]]]


class SideChannel:
    """Serves requests one after the other."""

    def __init__(self, handler: Handler, *, host: str, port: int) -> None:
        self._handler = handler
        self._host = host
        self._port = port
        self._server: asyncio.Server | None = None

    async def open(self) -> int:
        """Listen; returns the port."""
        self._server = await asyncio.start_server(self._serve, self._host, self._port)
        return int(self._server.sockets[0].getsockname()[1])

    def close(self) -> None:
        """Stop listening."""
        if self._server is not None:
            self._server.close()

    async def _serve(self, reader: asyncio.StreamReader, writer: asyncio.StreamWriter) -> None:
        try:
            while line := await reader.readline():
                writer.write(msgspec.json.encode(await self._answer(line)) + b"\n")
                await writer.drain()
        except ConnectionError:
            pass  # the client has ended
        finally:
            writer.close()

    async def _answer(self, line: bytes) -> Mapping[str, object]:
        try:
            return await self._handler(msgspec.json.decode(line, type=dict[str, object]))
        except (msgspec.DecodeError, msgspec.ValidationError, KeyError, TypeError, ValueError, OSError) as error:
            return {"error": f"{type(error).__name__}: {error}"}
