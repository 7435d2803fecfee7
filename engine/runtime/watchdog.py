"""Detects a state that blocks the event loop, and reports its path and source line.

A daemon thread looks at the loop's stack: twice a second while the loop has nothing to do, four
times while it works. Nothing is asked of the loop, so an idle one stays asleep. Each turn of the
loop has a frame of its own, so one that is seen again in the same turn has not come back in
between. A block of half a second is always noticed, one between the threshold and that mostly, one
below the threshold never. Code that holds the interpreter's lock keeps this thread from looking;
such a block is noticed if it goes on for a moment after the lock is free.

In virtual time blocks are logged and counted, and not recorded: an event log that repeats byte for
byte cannot tell how long something really took.
"""

from __future__ import annotations

import asyncio
import logging
import sys
import threading
import time
from collections import deque
from dataclasses import dataclass
from pathlib import Path
from types import CodeType, FrameType, TracebackType
from typing import Self

from engine.clock import VirtualLoop
from engine.event import LoopBlocked
from engine.runtime.nodes.execution import Execution
from engine.runtime.nodes.leaf import Leaf

_log = logging.getLogger("flexcell.watchdog")
_ENGINE = str(Path(__file__).parents[1])
_RUN_FOREVER: CodeType = asyncio.BaseEventLoop.run_forever.__code__
"""The frame that it has called is a turn of the loop: a new one for each turn."""
_LEAF_RUN: CodeType = Leaf.run.__code__
_LONGEST_S = 3600.0
_BLOCKED_LOOK_S = 0.05
_KEPT_BLOCKS = 100


@dataclass(frozen=True, kw_only=True)
class LoopStall:
    """A time in which the loop did not run: the state that kept it, and the line it was at.

    `blocked_s` is what was seen of it, at most a twentieth of a second too little at its end. `path`
    is empty when no state was running, but a device, a viewer or the engine itself.
    """

    path: str
    blocked_s: float
    where: str


@dataclass(kw_only=True)
class _Turn:
    """A turn of the loop that is under way: its frame, since when, and what was found out about it."""

    frame: FrameType
    since_s: float
    blocked_s: float = 0.0
    told_s: float = 0.0
    path: str = ""
    where: str = ""


class LoopWatchdog:
    """Watches the event loop of the thread it is entered on, for as long as it is entered.

    Args:
        threshold_s: How long the loop may be kept.
        idle_look_s: How often to look while the loop has nothing to do.
    """

    def __init__(self, *, threshold_s: float = 0.25, idle_look_s: float = 0.5) -> None:
        self.blocks: deque[LoopStall] = deque(maxlen=_KEPT_BLOCKS)
        """The newest blocks that have ended."""
        self._threshold_s = threshold_s
        self._idle_look_s = idle_look_s
        self._loop: asyncio.AbstractEventLoop | None = None
        self._thread_id = 0
        self._thread: threading.Thread | None = None
        # A lock that is never free: waiting for it with a time-out is the cheapest sleep that can be ended.
        self._stopped = threading.Lock()
        self._turn: _Turn | None = None
        self._seen = 0

    def __enter__(self) -> Self:
        """Begin to watch the running loop."""
        self._loop = asyncio.get_running_loop()
        self._thread_id = threading.get_ident()
        self._stopped.acquire()
        self._thread = threading.Thread(target=self._watch, name="flexcell watchdog", daemon=True)
        self._thread.start()
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        """Stop watching."""
        self._stopped.release()
        if self._thread is not None:
            self._thread.join()

    def _watch(self) -> None:
        pause_s = self._threshold_s
        while not self._stopped.acquire(timeout=pause_s):
            pause_s = self._look()
        self._end_turn()

    def _look(self) -> float:
        """Look at the loop's stack and return when to look again."""
        # There is no public way to another thread's stack; the underscore is that of the documented function.
        innermost = sys._current_frames().get(self._thread_id)  # pyright: ignore[reportPrivateUsage]
        frame, busy = _turn_of(innermost)
        if self._turn is not None and frame is not self._turn.frame:
            self._end_turn()
        if frame is None or innermost is None or not busy:
            # Of the frame only its identity is kept, or its locals would live on.
            moved = id(frame) != self._seen
            self._seen = id(frame)
            return self._threshold_s if moved else self._idle_look_s
        turn = self._turn = self._turn or _Turn(frame=frame, since_s=self._began_s(frame))
        turn.blocked_s = time.monotonic() - turn.since_s
        if turn.blocked_s < self._threshold_s:
            return self._threshold_s - turn.blocked_s
        if turn.blocked_s >= 2 * turn.told_s:
            self._tell(turn, innermost)
        return _BLOCKED_LOOK_S

    def _began_s(self, frame: FrameType) -> float:
        """Return when a turn began: its own note of it where there is one, else now."""
        now_s = time.monotonic()
        noted = None if isinstance(self._loop, VirtualLoop) else frame.f_locals.get("end_time")
        return noted if isinstance(noted, float) and 0.0 <= now_s - noted < _LONGEST_S else now_s

    def _tell(self, turn: _Turn, innermost: FrameType) -> None:
        """Log that the loop is blocked; the first time, have it recorded once the loop is back."""
        leaf = _leaf_of(innermost)
        turn.path, turn.where = _path_of(leaf), _place_of(innermost, leaf)
        who = turn.path or "something outside the states"
        # Nothing is late in virtual time, so nobody has to be disturbed.
        level = logging.INFO if isinstance(self._loop, VirtualLoop) else logging.WARNING
        _log.log(level, "%s has kept the event loop from running for %.2f s, at %s", who, turn.blocked_s, turn.where)
        if turn.told_s == 0.0 and leaf is not None and not isinstance(self._loop, VirtualLoop):
            execution = leaf.f_locals.get("execution")
            if self._loop is not None and isinstance(execution, Execution):
                self._loop.call_soon_threadsafe(self._record, turn, execution)
        turn.told_s = turn.blocked_s

    def _record(self, turn: _Turn, execution: Execution) -> None:
        """Record the block in the run concerned; the first thing the loop does when it is back."""
        execution.recorder.emit(
            LoopBlocked, path=turn.path, blocked_s=round(time.monotonic() - turn.since_s, 3), where=turn.where
        )

    def _end_turn(self) -> None:
        turn, self._turn = self._turn, None
        if turn is not None and turn.told_s:
            self.blocks.append(LoopStall(path=turn.path, blocked_s=round(turn.blocked_s, 3), where=turn.where))


def _turn_of(innermost: FrameType | None) -> tuple[FrameType | None, bool]:
    """Return the frame of the loop's present turn, and whether it does more than wait for something."""
    called: list[FrameType] = []
    frame = innermost
    while frame is not None and frame.f_code is not _RUN_FOREVER:
        called.append(frame)
        frame = frame.f_back
    if frame is None or not called:
        return None, False
    return called[-1], len(called) > 1 and called[-2].f_code.co_name != "select"


def _leaf_of(innermost: FrameType) -> FrameType | None:
    frame: FrameType | None = innermost
    while frame is not None and frame.f_code is not _LEAF_RUN:
        frame = frame.f_back
    return frame


def _path_of(leaf: FrameType | None) -> str:
    return str(leaf.f_locals.get("path", "")) if leaf is not None else ""


def _place_of(innermost: FrameType, leaf: FrameType | None) -> str:
    """Return the innermost line outside the engine and, where that is in a library, the state's line that led there."""
    frames: list[FrameType] = []
    frame: FrameType | None = innermost
    while frame is not None and frame is not leaf and frame.f_code is not _RUN_FOREVER:
        frames.append(frame)
        frame = frame.f_back
    outside = [f for f in frames if not f.f_code.co_filename.startswith(_ENGINE)] or frames or [innermost]
    here, state = outside[0], outside[-1]
    if leaf is None or here.f_code.co_filename == state.f_code.co_filename:
        return _line(here)
    own = next(f for f in outside if f.f_code.co_filename == state.f_code.co_filename)
    return f"{_line(here)}, called from {_line(own)}"


def _line(frame: FrameType) -> str:
    return f"{frame.f_code.co_filename}:{frame.f_lineno}"
