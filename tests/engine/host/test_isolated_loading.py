"""What loaded code raises is kept, but the operator's Ctrl-C is none of it."""

from __future__ import annotations

import signal

import pytest

from engine.host.isolated_loading import LoadFailure, load_isolated


def leave() -> None:
    raise KeyboardInterrupt


def test_what_is_raised_comes_back_with_its_line() -> None:
    failure = load_isolated("mine", leave)
    assert isinstance(failure, LoadFailure)
    assert str(failure).startswith(f"loading `mine` raised KeyboardInterrupt at {__file__}:")
    assert load_isolated("mine", lambda: 7) == 7


def test_ctrl_c_passes() -> None:
    # A shell starts what it runs in the background with SIGINT ignored.
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    try:
        with pytest.raises(KeyboardInterrupt):
            load_isolated("slow", lambda: signal.raise_signal(signal.SIGINT))
        assert signal.getsignal(signal.SIGINT) is signal.default_int_handler
    finally:
        signal.signal(signal.SIGINT, before)
