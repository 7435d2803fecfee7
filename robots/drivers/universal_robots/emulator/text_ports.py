"""Ports of text: the dashboard with an answer to each line, and the script ports that execute what they get."""

from __future__ import annotations

import asyncio
from collections.abc import Awaitable, Callable

from robots.drivers.universal_robots.emulator.link_faults import LinkFaults
from robots.drivers.universal_robots.emulator.urscript.urscript_syntax import UrscriptError
from robots.drivers.universal_robots.emulator.urscript.urscript_tokens import ProgramSplitter

_READ_BYTES = 65_536
LineAnswer = Callable[[str], str]
ProgramStart = Callable[[str], Awaitable[None]]
StreamHandler = Callable[[asyncio.StreamReader, asyncio.StreamWriter], Awaitable[None]]


def dashboard_port(answer: LineAnswer, faults: LinkFaults, *, banner: str) -> StreamHandler:
    """Return the handler of connections that get one answer to each line."""

    async def serve(reader: asyncio.StreamReader, writer: asyncio.StreamWriter) -> None:
        writer.write(f"{banner}\n".encode())
        while line := await reader.readline():
            await faults.alive()
            command = line.decode("utf-8", "replace").strip()
            await faults.delayed()
            writer.write(f"{answer(command)}\n".encode())
            if command == "quit":
                return

    return _until_closed(serve, faults)


def script_port(start: ProgramStart, faults: LinkFaults) -> StreamHandler:
    """Return the handler of connections that send programs."""

    async def serve(reader: asyncio.StreamReader, _writer: asyncio.StreamWriter) -> None:
        splitter = ProgramSplitter()
        while received := await reader.read(_READ_BYTES):
            await faults.alive()
            for program in splitter.feed(received.decode("utf-8", "replace")):
                await start(program)

    return _until_closed(serve, faults)


def _until_closed(serve: StreamHandler, faults: LinkFaults) -> StreamHandler:
    async def handle(reader: asyncio.StreamReader, writer: asyncio.StreamWriter) -> None:
        transport = writer.transport
        assert isinstance(transport, asyncio.Transport)
        if not faults.admit(transport):
            return
        try:
            await serve(reader, writer)
        except (ConnectionError, ValueError, UrscriptError):
            pass  # the client has ended, or has sent a line or a program without an end
        except asyncio.CancelledError:
            pass  # the emulator ends: asyncio would report this as an error of the handler
        finally:
            faults.forget(transport)
            writer.close()

    return handle
