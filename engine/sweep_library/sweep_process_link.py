"""A sweep process as the server sees it: started, asked over its socket, interrupted, ended."""

from __future__ import annotations

import asyncio
import signal
import socket
import subprocess
from pathlib import Path

import msgspec

from engine.errors import ControlError, DocumentError, FlexcellError, RobotError
from engine.host.child_process import describe_exit, start_child
from engine.sweep_library.sweep_files import NoSuchSweep
from engine.sweep_library.sweep_requests import (
    CODE,
    Answered,
    Proceeding,
    Refused,
    ShrinkProceeding,
    SweepAnswer,
    SweepRequest,
)

_LONGEST_LINE = 64_000_000
_WHAT = "the sweep process"


class SweepProcessLink:
    """A sweep process with its socket."""

    def __init__(
        self, process: subprocess.Popen[bytes], reader: asyncio.StreamReader, writer: asyncio.StreamWriter
    ) -> None:
        self._process = process
        self._reader = reader
        self._writer = writer

    @classmethod
    async def start(cls, project: Path) -> SweepProcessLink:
        """Start a process; raises RobotError."""
        ours, theirs = socket.socketpair()
        try:
            process = start_child(CODE, (theirs.fileno(),), what=_WHAT)
            reader, writer = await asyncio.open_connection(sock=ours, limit=_LONGEST_LINE)
        except BaseException:
            ours.close()
            raise
        finally:
            theirs.close()
        writer.write(f"{project}\n".encode())
        return cls(process, reader, writer)

    async def answer(self, request: SweepRequest, *, limit_s: float) -> bytes:
        """Return the answer to a request; raises FlexcellError where it is refused, RobotError without an answer."""
        await self.send(request)
        received = await self.receive(limit_s=limit_s)
        match received:
            case Answered():
                return bytes(received.body)
            case Refused():
                raise refusal(received)
            case Proceeding() | ShrinkProceeding():
                raise RobotError(f"{_WHAT} has answered something else")

    async def send(self, request: SweepRequest) -> None:
        """Send a request."""
        try:
            self._writer.write(msgspec.json.encode(request) + b"\n")
            await self._writer.drain()
        except ConnectionError as error:
            raise RobotError(describe_exit(self._process, what=_WHAT)) from error

    async def receive(self, *, limit_s: float | None) -> SweepAnswer:
        """Return its next answer; raises RobotError without one."""
        try:
            async with asyncio.timeout(limit_s):
                line = await self._reader.readline()
        except TimeoutError as error:
            raise RobotError(f"{_WHAT} has not answered within {limit_s:g} s") from error
        except (ConnectionError, ValueError) as error:
            raise RobotError(f"{_WHAT} cannot be read: {error}") from error
        if not line:
            raise RobotError(await asyncio.to_thread(describe_exit, self._process, what=_WHAT))
        return msgspec.json.decode(line, type=SweepAnswer)

    def interrupt(self) -> None:
        """Ask it to end what it executes."""
        self._process.send_signal(signal.SIGINT)

    def close(self) -> None:
        """End it: it has nothing that could be lost."""
        self._writer.close()
        self._process.kill()
        self._process.wait()


def refusal(refused: Refused) -> FlexcellError:
    """Return the error that a refusal tells of."""
    kinds = {"missing": NoSuchSweep, "state": ControlError, "invalid": DocumentError}
    message, where, hint = refused.words
    return kinds[refused.kind](message, where=where or None, hint=hint or None)
