"""What anybody outside can make a library log, again and again, is logged once a period."""

from __future__ import annotations

import logging
import time
from collections.abc import Callable, Generator
from contextlib import contextmanager

PERIOD_S = 10.0
_MAX_TEXTS = 1000
# The loops of the server and of viser, and uvicorn with its words about requests that are none.
_LOGGERS = ("asyncio", "uvicorn.error", "websockets.server")


class RepeatedLogFilter(logging.Filter):
    """Lets a text through once in `PERIOD_S`, however often it is logged."""

    def __init__(self, now_s: Callable[[], float] = time.monotonic) -> None:
        super().__init__()
        self._now_s = now_s
        self._told_s: dict[str, float] = {}

    def filter(self, record: logging.LogRecord) -> bool:
        """Say whether a record is logged."""
        now_s, text = self._now_s(), _text(record)
        if now_s - self._told_s.get(text, -PERIOD_S) < PERIOD_S:
            return False
        if len(self._told_s) >= _MAX_TEXTS:
            self._told_s.clear()
        self._told_s[text] = now_s
        return True


def _text(record: logging.LogRecord) -> str:
    """Return what two records have in common that say the same: first line, and where what they tell of was raised."""
    first = str(record.msg).partition("\n")[0]
    trace = record.exc_info[2] if record.exc_info else None
    while trace is not None and trace.tb_next is not None:
        trace = trace.tb_next
    place = f"{trace.tb_frame.f_code.co_filename}:{trace.tb_lineno}" if trace is not None else ""
    return f"{record.levelno} {first} {place}"


@contextmanager
def throttle_library_logs() -> Generator[None]:
    """Leave repeated texts of the libraries that serve out of the log."""
    loggers = [logging.getLogger(name) for name in _LOGGERS]
    repeats = RepeatedLogFilter()
    for logger in loggers:
        logger.addFilter(repeats)
    try:
        yield
    finally:
        for logger in loggers:
            logger.removeFilter(repeats)
