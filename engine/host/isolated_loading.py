"""Loads third-party code in isolation: an exception is caught and reported with its file and line."""

from __future__ import annotations

import signal
import traceback
from collections.abc import Callable, Generator
from contextlib import contextmanager
from dataclasses import dataclass
from threading import Event, current_thread, main_thread
from types import FrameType
from typing import TypeVar

T = TypeVar("T")


@dataclass(frozen=True, kw_only=True)
class LoadFailure:
    """The exception of a module or entry point that failed to load; `where` is `file:line`, empty when unknown."""

    name: str
    raised: str
    where: str

    def __str__(self) -> str:
        place = f" at {self.where}" if self.where else ""
        return f"loading `{self.name}` raised {self.raised}{place}"


def load_isolated(name: str, load: Callable[[], T]) -> T | LoadFailure:
    """Return the result of `load`, or its exception, including `SystemExit`; Ctrl-C of the operator is not caught."""
    with _detect_interrupt() as interrupted:
        try:
            return load()
        except BaseException as error:
            # A module may raise anything, even `SystemExit` and `KeyboardInterrupt`; only its own loading must fail.
            if interrupted.is_set():
                raise
            return LoadFailure(name=name, raised=_in_one_line(error), where=_raised_at(error))


@contextmanager
def _detect_interrupt() -> Generator[Event]:
    """Distinguish the operator's Ctrl-C from a `KeyboardInterrupt` that the loaded code raises."""
    pressed = Event()
    own = signal.getsignal(signal.SIGINT) is signal.default_int_handler
    if not own or current_thread() is not main_thread():
        yield pressed
        return

    def note(number: int, frame: FrameType | None) -> None:
        pressed.set()
        signal.default_int_handler(number, frame)

    signal.signal(signal.SIGINT, note)
    try:
        yield pressed
    finally:
        signal.signal(signal.SIGINT, signal.default_int_handler)


def _in_one_line(error: BaseException) -> str:
    kind = type(error).__name__
    try:
        text = " ".join(str(error).split())
    except Exception:
        # The exception class belongs to the loaded code, so its text may raise too.
        text = ""
    return f"{kind}: {text}" if text else kind


def _raised_at(error: BaseException) -> str:
    if isinstance(error, SyntaxError) and error.filename:
        return f"{error.filename}:{error.lineno or 1}"
    frames = traceback.extract_tb(error.__traceback__)
    own = [frame for frame in frames if not frame.filename.startswith("<frozen") and frame.filename != __file__]
    # Importing passes through importlib itself, which is not the source of the error.
    own = [frame for frame in own if "/importlib/" not in frame.filename]
    return f"{own[-1].filename}:{own[-1].lineno}" if own else ""
