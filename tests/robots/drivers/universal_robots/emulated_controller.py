"""The emulator as a process of its own, and its side channel, for tests."""

from __future__ import annotations

import json
import select
import socket
import subprocess
import sys
from collections.abc import Mapping
from types import TracebackType
from typing import Any, Self

from tests.robots.own_address import own_address

ANSWER_LIMIT_S = 60.0
"""An answer that takes longer will not come; a machine of two busy cores is slow."""


def read_line(process: subprocess.Popen[bytes], what: str) -> Mapping[str, Any]:
    """Return the next line of a process, as JSON."""
    assert process.stdout is not None
    ready, _, _ = select.select([process.stdout], [], [], ANSWER_LIMIT_S)
    assert ready, f"{what} does not answer"
    line = process.stdout.readline()
    assert line, f"{what} has ended with exit code {process.wait()}"
    return json.loads(line)


class EmulatedController:
    """One emulator, from its ready line to the end of the block."""

    def __init__(self, *, series: str = "cb3", model: str = "ur10") -> None:
        self.host = own_address()
        self._options = ["--host", self.host, "--series", series, "--model", model]

    def __enter__(self) -> Self:
        command = [sys.executable, "-m", "robots.drivers.universal_robots.emulator", *self._options]
        self._process = subprocess.Popen(command, stdout=subprocess.PIPE)
        assert read_line(self._process, "the emulator")["ready"]
        self._channel = socket.create_connection((self.host, 29900), timeout=ANSWER_LIMIT_S)
        self._answers = self._channel.makefile("rb")
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, traceback: TracebackType | None
    ) -> None:
        self._answers.close()
        self._channel.close()
        self._process.terminate()
        assert self._process.wait(ANSWER_LIMIT_S) == 0
        assert self._process.stdout is not None
        self._process.stdout.close()

    def restart(self) -> None:
        """Switch the controller off and on: it forgets everything."""
        self.__exit__(None, None, None)
        self.__enter__()

    def ask(self, do: str, **fields: object) -> Mapping[str, Any]:
        """Send a request to the side channel and return its answer."""
        self._channel.sendall(json.dumps({"do": do, **fields}).encode() + b"\n")
        answer = json.loads(self._answers.readline())
        assert "error" not in answer, answer
        return answer

    def state(self) -> Mapping[str, Any]:
        """Return the true state."""
        return self.ask("state")

    def wait(self, until: str) -> Mapping[str, Any]:
        """Return the state when it is so."""
        return self.ask("wait", until=until)
