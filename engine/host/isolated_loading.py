"""Loads third-party code in isolation: an exception is kept and reported with its file and line."""

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
    """What a module or entry point raised instead of being loaded; `where` is `file:line`, empty where unknown."""

    name: str
    raised: str
    where: str

    def __str__(self) -> str:
        place = f" at {self.where}" if self.where else ""
        return f"loading `{self.name}` raised {self.raised}{place}"


def load_isolated(name: str, load: Callable[[], T]) -> T | LoadFailure:
    """Return what `load` returns, or what it raised, be it `SystemExit`; Ctrl-C of the operator passes."""
    with _interrupt_noted() as interrupted:
        try:
            return load()
        except BaseException as error:
            # A module may raise anything, `SystemExit` and `KeyboardInterrupt` too; it must end nothing but itself.
            if interrupted.is_set():
                raise
            return LoadFailure(name=name, raised=_in_one_line(error), where=_raised_at(error))


@contextmanager
def _interrupt_noted() -> Generator[Event]:
    """Tell the operator's Ctrl-C from a `KeyboardInterrupt` that the loaded code raises."""
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
        # The exception is of the loaded code too, and so is its text.
        text = ""
    return f"{kind}: {text}" if text else kind


def _raised_at(error: BaseException) -> str:
    if isinstance(error, SyntaxError) and error.filename:
        return f"{error.filename}:{error.lineno or 1}"
    frames = traceback.extract_tb(error.__traceback__)
    own = [frame for frame in frames if not frame.filename.startswith("<frozen") and frame.filename != __file__]
    # Importing goes through importlib itself, which is not where anything went wrong.
    own = [frame for frame in own if "/importlib/" not in frame.filename]
    return f"{own[-1].filename}:{own[-1].lineno}" if own else ""
