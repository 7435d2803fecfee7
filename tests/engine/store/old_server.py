"""A server that speaks just enough of the protocol to say that it is an old MongoDB."""

from __future__ import annotations

import asyncio
import struct
from types import TracebackType
from typing import Any, Self

import bson

_OP_REPLY = 1
_OP_MSG = 2013


class OldServer:
    """MongoDB 3.6 as far as anybody asks: wire version 6."""

    def __init__(self) -> None:
        self._server: asyncio.Server | None = None
        self._tasks: set[asyncio.Task[None]] = set()
        self.port = 0

    async def __aenter__(self) -> Self:
        self._server = await asyncio.start_server(self._answer, "127.0.0.1", 0)
        self.port = int(self._server.sockets[0].getsockname()[1])
        return self

    async def __aexit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        assert self._server is not None
        self._server.close()
        for task in tuple(self._tasks):
            task.cancel()
        await asyncio.gather(*self._tasks, return_exceptions=True)

    async def _answer(self, reader: asyncio.StreamReader, writer: asyncio.StreamWriter) -> None:
        task = asyncio.current_task()
        assert task is not None
        self._tasks.add(task)
        hello: dict[str, Any] = {
            "ok": 1,
            "ismaster": True,
            "minWireVersion": 0,
            "maxWireVersion": 6,
            "maxBsonObjectSize": 1,
        }
        document = bson.encode(hello)
        try:
            while True:
                length, request, _, code = struct.unpack("<iiii", await reader.readexactly(16))
                await reader.readexactly(length - 16)
                body = struct.pack("<iB", 0, 0) if code == _OP_MSG else struct.pack("<iqii", 8, 0, 0, 1)
                kind = _OP_MSG if code == _OP_MSG else _OP_REPLY
                writer.write(struct.pack("<iiii", 16 + len(body) + len(document), 0, request, kind) + body + document)
        except (asyncio.IncompleteReadError, ConnectionError):
            # The client has gone.
            pass
        finally:
            writer.transport.abort()
            self._tasks.discard(task)
