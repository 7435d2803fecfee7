"""A worker process of this one: started, asked over a socket, and ended, on the event loop."""

from __future__ import annotations

import asyncio
import socket
import subprocess
from collections.abc import Callable, Mapping
from contextlib import suppress
from types import UnionType
from typing import Generic, TypeVar

from engine.errors import RobotError
from engine.host.child_process import describe_exit, start_child
from robots.io.worker_connection import PendingRequest, WorkerConnection

Sent = TypeVar("Sent")
Received = TypeVar("Received")


class WorkerProcess(Generic[Sent, Received]):
    """One process, used once: after a loss, create another one.

    Args:
        code: The Python code of the process; the first of its arguments is the descriptor of the socket.
        received: The union of the types of received messages.
        what: Names the process in messages.
        hint: What to do, or what is done, after a loss.
        settings: Additional environment variables of the process.
        on_notice: Called with messages that answer no request.
        on_lost: Called once with the reason when the process is lost or was ended.
    """

    def __init__(
        self,
        code: str,
        received: type[Received] | UnionType,
        *,
        what: str,
        hint: str,
        settings: Mapping[str, str] | None = None,
        on_notice: Callable[[Received], None] = lambda _message: None,
        on_lost: Callable[[str], None] = lambda _reason: None,
    ) -> None:
        self._code = code
        self._received = received
        self._what = what
        self._hint = hint
        self._settings = settings
        self._on_notice = on_notice
        self._on_lost = on_lost
        self._process: subprocess.Popen[bytes] | None = None
        self._connection: WorkerConnection[Sent, Received] | None = None
        self.end_reason = ""
        """Why the process will have ended, if this process ends it; else its exit is described."""

    @property
    def pid(self) -> int:
        """The process id, 0 while there is none."""
        return self._process.pid if self._process is not None and self._process.poll() is None else 0

    @property
    def lost_reason(self) -> str:
        """Why the process cannot be asked; empty while it can."""
        return self._connection.lost_reason if self._connection is not None else f"{self._what} was ended"

    async def start(self, *descriptors: int) -> None:
        """Start the process with the socket and `descriptors`; what it needs to be ready, it is asked.

        Raises:
            RobotError: the process does not start.
        """
        ours, theirs = socket.socketpair()
        try:
            self._process = start_child(
                self._code, (theirs.fileno(), *descriptors), what=self._what, settings=self._settings
            )
            # Closed before the process can end, else its end would not be noticed.
            theirs.close()
            loop = asyncio.get_running_loop()
            _, self._connection = await loop.create_connection(self._new_connection, sock=ours)
        except BaseException:
            # On any error, cancellation included, no process may be left behind.
            ours.close()
            self.end()
            raise
        finally:
            theirs.close()

    def ask(self, message: Sent) -> PendingRequest[Received]:
        """Send a request; raises RobotError and answers as `WorkerConnection.ask` does."""
        return self._connected().ask(message)

    def send(self, message: Sent, *, number: int = 0) -> None:
        """Send a message that wants no answer; raises RobotError when the process is lost."""
        self._connected().send(message, number=number)

    async def wait_closed(self, limit_s: float) -> None:
        """Wait until the process has closed its socket, at most `limit_s`."""
        if self._connection is not None:
            await asyncio.wait((self._connection.closed,), timeout=limit_s)

    def kill(self, reason: str) -> None:
        """Kill the process now, and report its loss with `reason`; `end` is still due."""
        if self._process is not None:
            self._process.kill()
        if self._connection is not None:
            self._connection.lose(self.end_reason or reason)
            self._connection.close()

    def end(self, *, grace_s: float = 0.0) -> None:
        """Close the socket and end the process, which may take `grace_s` to end by itself."""
        if self._connection is not None:
            self._connection.close()
        process, self._process = self._process, None
        if process is None:
            return
        if grace_s > 0.0:
            with suppress(subprocess.TimeoutExpired):
                process.wait(timeout=grace_s)
        process.kill()
        process.wait()

    def _new_connection(self) -> WorkerConnection[Sent, Received]:
        return WorkerConnection(
            self._received,
            what=self._what,
            hint=self._hint,
            describe_end=lambda: self.end_reason or describe_exit(self._process, what=self._what),
            on_notice=self._on_notice,
            on_lost=self._on_lost,
        )

    def _connected(self) -> WorkerConnection[Sent, Received]:
        if self._connection is None:
            raise RobotError(f"{self._what} was ended", hint=self._hint)
        return self._connection
