"""What anybody can make a library say again and again is said once a period."""

from __future__ import annotations

import logging

import pytest

from editor_web.transport.log_throttle import PERIOD_S, RepeatedLogFilter, throttle_library_logs


def record(text: str, *arguments: object) -> logging.LogRecord:
    """A warning."""
    return logging.LogRecord("x", logging.WARNING, __file__, 1, text, arguments, None)


def test_the_same_text_is_said_once_a_period() -> None:
    """Whatever is filled into it; another one is said at once."""
    now_s = [0.0]
    repeats = RepeatedLogFilter(lambda: now_s[0])
    assert [repeats.filter(record("bad %d", n)) for n in range(100)] == [True] + [False] * 99
    assert repeats.filter(record("other"))
    now_s[0] += PERIOD_S
    assert repeats.filter(record("bad %d", 1))


def test_the_loggers_are_as_before_afterwards(caplog: pytest.LogCaptureFixture) -> None:
    """Inside repeats are left out."""
    logger = logging.getLogger("uvicorn.error")
    with throttle_library_logs():
        for _ in range(100):
            logger.warning("Invalid HTTP request received.")
    assert len(caplog.records) == 1
    logger.warning("Invalid HTTP request received.")
    assert len(caplog.records) == 2
