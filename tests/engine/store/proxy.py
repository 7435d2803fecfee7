"""A TCP relay between a store and its server that a test can cut, and that can swallow one answer."""

from __future__ import annotations

import asyncio
from types import TracebackType
from typing import Self


class Proxy:
    """Relays to `port` on the loopback; its own port is `self.port`."""

    def __init__(self, port: int) -> None:
        self._target = port
        self._server: asyncio.Server | None = None
        self._open: set[asyncio.StreamWriter] = set()
        self._relays: set[asyncio.Task[None]] = set()
        self._swallow: bytes | None = None
        self._up = True
        self._hold: bytes | None = None
        self.swallowed = asyncio.Event()
        self.held = asyncio.Event()
        self.released = asyncio.Event()
        self.port = 0

    @property
    def uri(self) -> str:
        """The address of the server through the relay, and never around it."""
        return f"mongodb://127.0.0.1:{self.port}/?directConnection=true"

    def cut(self) -> None:
        """Break all connections and accept no new ones."""
        self._up = False
        for writer in tuple(self._open):
            writer.transport.abort()

    def restore(self) -> None:
        """Let connections through again."""
        self._up = True

    def swallow_answer_to(self, text: bytes) -> None:
        """Let the next request with this text reach the server, but not its answer, and then `cut`."""
        self._swallow = text

    def hold_request(self, text: bytes) -> None:
        """Keep the next request with this text, from `held` until `released`."""
        self._hold = text

    async def __aenter__(self) -> Self:
        self._server = await asyncio.start_server(self._relay, "127.0.0.1", 0)
        self.port = int(self._server.sockets[0].getsockname()[1])
        return self

    async def __aexit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        assert self._server is not None
        self._server.close()
        self.cut()
        await asyncio.gather(*self._relays, return_exceptions=True)

    async def _relay(self, reader: asyncio.StreamReader, writer: asyncio.StreamWriter) -> None:
        task = asyncio.current_task()
        assert task is not None
        self._relays.add(task)
        try:
            if self._up:
                there_reader, there = await asyncio.open_connection("127.0.0.1", self._target)
                self._open |= {writer, there}
                mute = asyncio.Event()
                await asyncio.gather(
                    self._up_stream(reader, there, mute), self._down_stream(there_reader, writer, mute)
                )
        except OSError:
            # A connection that breaks is what this is for.
            pass
        finally:
            writer.transport.abort()
            self._open.discard(writer)
            self._relays.discard(task)

    async def _up_stream(self, reader: asyncio.StreamReader, there: asyncio.StreamWriter, mute: asyncio.Event) -> None:
        while data := await reader.read(65536):
            if self._swallow is not None and self._swallow in data:
                self._swallow = None
                mute.set()
            if self._hold is not None and self._hold in data:
                self._hold = None
                self.held.set()
                await self.released.wait()
            there.write(data)
        there.close()
        self._open.discard(there)

    async def _down_stream(
        self, there: asyncio.StreamReader, writer: asyncio.StreamWriter, mute: asyncio.Event
    ) -> None:
        while data := await there.read(65536):
            if mute.is_set():
                self.cut()
                self.swallowed.set()
                return
            writer.write(data)
        writer.close()
