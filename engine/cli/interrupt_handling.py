"""What SIGINT and SIGTERM mean to a run: stop; then tell what is waited for; then leave at once."""

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
_LEFT = b"flexcell: left at once, whatever moves; the journal holds what was committed: `flexcell runs`\n"


class InterruptHandler:
    """Catches the signals while it is entered, whether they come before the run is made or while it goes on.

    The handlers run between two instructions of the main thread, so a state that blocks the loop
    does not keep the third signal from ending the process.

    Args:
        say: Tells the person who sends the signals.
    """

    def __init__(self, say: Callable[[str], None]) -> None:
        self.reason = ""
        self._say = say
        self._run: Run | None = None
        self._count = 0
        self._loop = asyncio.get_running_loop()
        self._before: dict[signal.Signals, Any] = {}

    def watch_over(self, run: Run) -> None:
        """Stop `run` at the next signal, or at once when there was one."""
        self._run = run
        if self.reason:
            run.stop(self.reason)

    def __enter__(self) -> Self:
        for number in _SIGNALS:
            self._before[number] = signal.signal(number, self._caught)
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        for number, handler in self._before.items():
            signal.signal(number, handler)

    def _caught(self, number: int, frame: FrameType | None) -> None:
        self._count += 1
        if self._count > 2:
            os.write(2, _LEFT)
            os._exit(ExitCode.INTERRUPTED)
        # One turn later: a run that is just beginning enters its first state and is seen to leave it.
        self._loop.call_soon_threadsafe(self._loop.call_soon, self._stop, signal.Signals(number).name)

    def _stop(self, name: str) -> None:
        if not self.reason:
            self.reason = f"interrupted by {name}"
            if self._run is not None:
                self._run.stop(self.reason)
            return
        busy = ", ".join(self._run.active_states) if self._run is not None and not self._run.ended else ""
        self._say(f"waiting for {busy or 'the cell'} to come to rest; once more leaves at once")
