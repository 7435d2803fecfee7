"""Checks the targets of texts under edit in a separate process, without blocking the server and its event loop."""

from __future__ import annotations

import asyncio
import logging
import socket
import subprocess
from pathlib import Path
from typing import Literal

import msgspec

from engine.editing.targets.target_messages import TargetFindings, TargetRequest
from engine.errors import RobotError
from engine.host.child_process import start_child

START = "from engine.editing.targets.target_process import main; main()"
LIMIT_S = 60.0
"""Time limit of a response, including what the first one loads and compiles on a busy computer."""
_WHAT = "the target check process"
_LONGEST_LINE = 8_000_000
_log = logging.getLogger("flexcell.documents")


class TargetChecks:
    """Checks targets of one text after the other; belongs to one event loop. `close` ends the process.

    The process starts with the first text that names a cell. If it does not answer in time, or dies, it is ended, and
    the next text starts a new one.

    Args:
        project: Folder that references of texts must not leave.
        limit_s: Time limit of a response.
        start: The Python code of the process.
    """

    def __init__(self, project: Path, *, limit_s: float = LIMIT_S, start: str = START) -> None:
        self._project = project.resolve()
        self.limit_s = limit_s
        self._start = start
        self._latest: dict[str, int] = {}
        self._turn = asyncio.Lock()
        self._numbers = 0
        self._process: subprocess.Popen[bytes] | None = None
        self._streams: tuple[asyncio.StreamReader, asyncio.StreamWriter] | None = None

    @property
    def pid(self) -> int:
        """The process id; 0 while no process runs."""
        return self._process.pid if self._process is not None else 0

    async def findings(
        self, asker: str, file: Path, text: str, *, of: Literal["behavior", "cell"] = "behavior"
    ) -> TargetFindings | None:
        """Return the targets in a text that an arm of its cell cannot take; of a cell what touches at rest.

        None if the same client has requested a check of a newer text before this check started.

        Args:
            asker: The client: a page and its document.
            file: File that the text belongs to.
            text: A behavior document, or that of a cell.
            of: Which of them it is.
        """
        self._numbers += 1
        number = self._latest[asker] = self._numbers
        try:
            async with self._turn:
                return await self._asked(file, text, of) if self._latest[asker] == number else None
        finally:
            if self._latest.get(asker) == number:
                del self._latest[asker]

    def close(self) -> None:
        """End the process."""
        streams, self._streams = self._streams, None
        if streams is not None:
            streams[1].close()
        process, self._process = self._process, None
        if process is not None:
            # The process has no state that could be lost.
            process.kill()
            process.wait()

    async def _asked(self, file: Path, text: str, of: Literal["behavior", "cell"]) -> TargetFindings:
        request = TargetRequest(project=str(self._project), file=str(file), text=text, of=of)
        try:
            async with asyncio.timeout(self.limit_s):
                return await self._answer(request)
        except TimeoutError:
            self.close()
            return self._unknown(f"no answer within {self.limit_s:g} s")
        except (OSError, RobotError, ValueError, msgspec.DecodeError) as error:
            self.close()
            return self._unknown(str(error) or type(error).__name__)
        except asyncio.CancelledError:
            # Its late response would be mistaken for the response to the next text.
            self.close()
            raise

    async def _answer(self, request: TargetRequest) -> TargetFindings:
        reader, writer = await self._running()
        writer.write(msgspec.json.encode(request) + b"\n")
        await writer.drain()
        line = await reader.readline()
        if not line:
            raise RobotError(f"{_WHAT} has ended")
        return msgspec.json.decode(line, type=TargetFindings)

    async def _running(self) -> tuple[asyncio.StreamReader, asyncio.StreamWriter]:
        if self._streams is None:
            ours, theirs = socket.socketpair()
            try:
                self._process = start_child(self._start, (theirs.fileno(),), what=_WHAT)
                self._streams = await asyncio.open_connection(sock=ours, limit=_LONGEST_LINE)
            except BaseException:
                ours.close()
                raise
            finally:
                theirs.close()
        return self._streams

    def _unknown(self, reason: str) -> TargetFindings:
        _log.warning("the targets of a document cannot be checked: %s", reason)
        return TargetFindings(problem=f"the targets cannot be checked: {reason}")
