"""Handles SIGINT and SIGTERM of a run: first stop, then print what the stop waits for, then exit immediately."""

from __future__ import annotations

import asyncio
import os
import signal
from collections.abc import Callable
from types import FrameType, TracebackType
from typing import Any, Self

from engine.cli.exit_code import ExitCode
from engine.runtime.run import Run

_SIGNALS = (signal.SIGINT, signal.SIGTERM)
_EXITED = b"flexcell: exited immediately, robots may still move; committed events are in the journal: `flexcell runs`\n"


class InterruptHandler:
    """Handles the signals while the context is entered, before the run exists and while it executes.

    The handlers run between two instructions of the main thread, so the third signal ends the process
    even if a state blocks the event loop.

    Args:
        say: Prints a message on the terminal.
    """

    def __init__(self, say: Callable[[str], None]) -> None:
        self.reason = ""
        self._say = say
        self._run: Run | None = None
        self._count = 0
        self._loop = asyncio.get_running_loop()
        self._before: dict[signal.Signals, Any] = {}

    def watch_over(self, run: Run) -> None:
        """Stop `run` at the next signal, or immediately if one has arrived already."""
        self._run = run
        if self.reason:
            run.stop(self.reason)

    def __enter__(self) -> Self:
        for number in _SIGNALS:
            self._before[number] = signal.signal(number, self._on_signal)
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        for number, handler in self._before.items():
            signal.signal(number, handler)

    def _on_signal(self, number: int, frame: FrameType | None) -> None:
        self._count += 1
        if self._count > 2:
            os.write(2, _EXITED)
            os._exit(ExitCode.INTERRUPTED)
        # One loop iteration later: a run that is just starting enters its first state and records its exit.
        self._loop.call_soon_threadsafe(self._loop.call_soon, self._stop, signal.Signals(number).name)

    def _stop(self, name: str) -> None:
        if not self.reason:
            self.reason = f"interrupted by {name}"
            if self._run is not None:
                self._run.stop(self.reason)
            return
        busy = ", ".join(self._run.active_states) if self._run is not None and not self._run.ended else ""
        self._say(f"waiting for {busy or 'the cell'} to come to rest; press Ctrl-C again to exit immediately")
