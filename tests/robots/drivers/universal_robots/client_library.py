"""The client library in a process of its own, for tests."""

from __future__ import annotations

import json
import subprocess
import sys
from collections.abc import Callable
from importlib.util import find_spec
from pathlib import Path
from types import TracebackType
from typing import Any, Self

import pytest

from tests.robots.drivers.universal_robots.emulated_controller import ANSWER_LIMIT_S, read_line

MAIN = Path(__file__).with_name("client_library_main.py")
needs_client_library = pytest.mark.skipif(
    find_spec("rtde_control") is None, reason="ur-rtde is not installed: it has no wheel for this Python or machine"
)


class LibraryError(Exception):
    """What the library has raised."""


class ClientLibrary:
    """One process that calls the library; its interfaces are `control`, `receive`, `io` and `dashboard`."""

    def __init__(self, host: str, *interfaces: str) -> None:
        self._host = host
        self._interfaces = interfaces

    def __enter__(self) -> Self:
        self._process = subprocess.Popen(
            [sys.executable, MAIN, self._host], stdin=subprocess.PIPE, stdout=subprocess.PIPE
        )
        for name in self._interfaces:
            self.call(f"{name}.open")
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, traceback: TracebackType | None
    ) -> None:
        self._process.kill()
        self._process.wait(ANSWER_LIMIT_S)
        assert self._process.stdin is not None
        assert self._process.stdout is not None
        self._process.stdin.close()
        self._process.stdout.close()

    def send(self, call: str, *arguments: object) -> None:
        """Start a call."""
        assert self._process.stdin is not None
        self._process.stdin.write(json.dumps({"call": call, "arguments": arguments}).encode() + b"\n")
        self._process.stdin.flush()

    def receive(self) -> Any:
        """Return the result of the call that was sent; raises LibraryError."""
        answer = read_line(self._process, "the client library")
        if "error" in answer:
            raise LibraryError(answer["error"])
        return answer["result"]

    def until(self, call: str, *arguments: object) -> None:
        """Repeat a call until its result is true."""
        self.until_that(call, bool, *arguments)

    def until_that(self, call: str, is_so: Callable[[Any], bool], *arguments: object) -> None:
        """Repeat a call until its result is so; what the library knows is late, and more so on a loaded machine."""
        results = (self.call(call, *arguments) for _ in range(100_000))
        assert any(is_so(result) for result in results), f"{call} stays {self.call(call, *arguments)}"

    def call(self, call: str, *arguments: object) -> Any:
        """Return the result of a call; raises LibraryError."""
        self.send(call, *arguments)
        return self.receive()
