"""Throttles repeated log messages of libraries that a client can trigger."""

from __future__ import annotations

import logging
import time
from collections.abc import Callable, Generator
from contextlib import contextmanager

PERIOD_S = 10.0
_MAX_TEXTS = 1000
# The event loops of the server and of viser, and uvicorn's messages about invalid requests.
_LOGGERS = ("asyncio", "uvicorn.error", "websockets.server")


class RepeatedLogFilter(logging.Filter):
    """Passes each text at most once per `PERIOD_S`."""

    def __init__(self, now_s: Callable[[], float] = time.monotonic) -> None:
        super().__init__()
        self._now_s = now_s
        self._logged_s: dict[str, float] = {}

    def filter(self, record: logging.LogRecord) -> bool:
        """Return whether a record is logged."""
        now_s, text = self._now_s(), _text(record)
        if now_s - self._logged_s.get(text, -PERIOD_S) < PERIOD_S:
            return False
        if len(self._logged_s) >= _MAX_TEXTS:
            self._logged_s.clear()
        self._logged_s[text] = now_s
        return True


def _text(record: logging.LogRecord) -> str:
    """Return the key that equal records share: level, first line, and the location of the exception."""
    first = str(record.msg).partition("\n")[0]
    trace = record.exc_info[2] if record.exc_info else None
    while trace is not None and trace.tb_next is not None:
        trace = trace.tb_next
    place = f"{trace.tb_frame.f_code.co_filename}:{trace.tb_lineno}" if trace is not None else ""
    return f"{record.levelno} {first} {place}"


@contextmanager
def throttle_library_logs() -> Generator[None]:
    """Throttle repeated log messages of the server libraries in this context."""
    loggers = [logging.getLogger(name) for name in _LOGGERS]
    repeats = RepeatedLogFilter()
    for logger in loggers:
        logger.addFilter(repeats)
    try:
        yield
    finally:
        for logger in loggers:
            logger.removeFilter(repeats)
