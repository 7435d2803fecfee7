"""SIGINT and SIGTERM as a callback on the event loop."""

from __future__ import annotations

import asyncio
import signal
from collections.abc import Callable
from types import FrameType


def end_at_signals(end: Callable[[], object]) -> None:
    """Call `end` on the running loop at SIGINT and SIGTERM, from now on.

    asyncio's own handlers would hide the signals from the stop relay.
    """
    loop = asyncio.get_running_loop()

    def on_signal(_number: int, _frame: FrameType | None) -> None:
        loop.call_soon_threadsafe(end)

    for number in (signal.SIGINT, signal.SIGTERM):
        signal.signal(number, on_signal)
