"""Detects a state that blocks the event loop, and reports its path and source line.

A daemon thread samples the stack of the loop: twice a second while the loop is idle, four times while it works. It
schedules nothing on the loop, so an idle loop stays asleep. Each iteration of the loop has its own frame, so a loop
that is sampled twice with the same frame has not returned in between. A block of half a second is always detected, a
block between the threshold and that mostly, one below the threshold never. Code that holds the interpreter lock stops
this thread; such a block is detected if it continues briefly after the lock is released.

In virtual time blocks are logged and counted, and not recorded: an event log that must be reproducible byte for byte
cannot contain real durations.
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
"""Its callee frame is one iteration of the loop: a new frame for each iteration."""
_LEAF_RUN: CodeType = Leaf.run.__code__
_LONGEST_S = 3600.0
_BLOCKED_LOOK_S = 0.05
_KEPT_BLOCKS = 100


@dataclass(frozen=True, kw_only=True)
class LoopStall:
    """A period in which the loop was blocked: the blocking state, and its source line.

    `blocked_s` is the observed duration, at most 0.05 s too short. `path` is empty when a device, a viewer or the
    engine itself blocked the loop instead of a state.
    """

    path: str
    blocked_s: float
    where: str


@dataclass(kw_only=True)
class _Turn:
    """The current iteration of the loop: its frame, its start, and the findings about it."""

    frame: FrameType
    since_s: float
    blocked_s: float = 0.0
    reported_s: float = 0.0
    path: str = ""
    where: str = ""


class LoopWatchdog:
    """Watches the event loop of the thread that enters it, while it is entered.

    Args:
        threshold_s: Maximum duration of an iteration of the loop.
        idle_look_s: Sampling period while the loop is idle.
    """

    def __init__(self, *, threshold_s: float = 0.25, idle_look_s: float = 0.5) -> None:
        self.blocks: deque[LoopStall] = deque(maxlen=_KEPT_BLOCKS)
        """The most recent blocks that have ended."""
        self._threshold_s = threshold_s
        self._idle_look_s = idle_look_s
        self._loop: asyncio.AbstractEventLoop | None = None
        self._thread_id = 0
        self._thread: threading.Thread | None = None
        # A lock that is never free: waiting for it with a timeout is the cheapest interruptible sleep.
        self._stopped = threading.Lock()
        self._turn: _Turn | None = None
        self._last_frame_id = 0

    def __enter__(self) -> Self:
        """Start watching the running loop."""
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
            pause_s = self._sampled()
        self._end_turn()

    def _sampled(self) -> float:
        """Sample, and go on with the next sample where the stack of the other thread cannot be read."""
        try:
            return self._sample()
        except Exception:
            # CPython 3.11 has once given something that is no frame as the caller of a frame that was executing.
            _log.exception("the stack of the event loop could not be read; the watchdog goes on")
            self._turn = None
            return self._idle_look_s

    def _sample(self) -> float:
        """Sample the stack of the loop and return the time until the next sample."""
        # No public function returns the stack of another thread; this underscored function is documented.
        innermost = sys._current_frames().get(self._thread_id)  # pyright: ignore[reportPrivateUsage]
        frame, busy = _turn_of(innermost)
        if self._turn is not None and frame is not self._turn.frame:
            self._end_turn()
        if frame is None or innermost is None or not busy:
            # Only the identity of the frame is kept, or its locals would stay alive.
            has_advanced = id(frame) != self._last_frame_id
            self._last_frame_id = id(frame)
            return self._threshold_s if has_advanced else self._idle_look_s
        turn = self._turn = self._turn or _Turn(frame=frame, since_s=self._started_s(frame))
        turn.blocked_s = time.monotonic() - turn.since_s
        if turn.blocked_s < self._threshold_s:
            return self._threshold_s - turn.blocked_s
        if turn.blocked_s >= 2 * turn.reported_s:
            self._report(turn, innermost)
        return _BLOCKED_LOOK_S

    def _started_s(self, frame: FrameType) -> float:
        """Return the start time of an iteration: its own variable where it has one, else now."""
        now_s = time.monotonic()
        start_s = None if isinstance(self._loop, VirtualLoop) else frame.f_locals.get("end_time")
        return start_s if isinstance(start_s, float) and 0.0 <= now_s - start_s < _LONGEST_S else now_s

    def _report(self, turn: _Turn, innermost: FrameType) -> None:
        """Log that the loop is blocked; the first time, also record it once the loop runs again."""
        leaf = _leaf_of(innermost)
        turn.path, turn.where = _path_of(leaf), _source_line(innermost, leaf)
        blocker = turn.path or "code outside the states"
        # In virtual time no deadline is missed, so no warning is needed.
        level = logging.INFO if isinstance(self._loop, VirtualLoop) else logging.WARNING
        _log.log(level, "%s has blocked the event loop for %.2f s, at %s", blocker, turn.blocked_s, turn.where)
        if turn.reported_s == 0.0 and leaf is not None and not isinstance(self._loop, VirtualLoop):
            execution = leaf.f_locals.get("execution")
            if self._loop is not None and isinstance(execution, Execution):
                self._loop.call_soon_threadsafe(self._record, turn, execution)
        turn.reported_s = turn.blocked_s

    def _record(self, turn: _Turn, execution: Execution) -> None:
        """Record the block in the run concerned; called first when the loop runs again."""
        execution.recorder.emit(
            LoopBlocked, path=turn.path, blocked_s=round(time.monotonic() - turn.since_s, 3), where=turn.where
        )

    def _end_turn(self) -> None:
        turn, self._turn = self._turn, None
        if turn is not None and turn.reported_s:
            self.blocks.append(LoopStall(path=turn.path, blocked_s=round(turn.blocked_s, 3), where=turn.where))


def _turn_of(innermost: FrameType | None) -> tuple[FrameType | None, bool]:
    """Return the frame of the current iteration of the loop, and whether it executes code instead of waiting."""
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


def _source_line(innermost: FrameType, leaf: FrameType | None) -> str:
    """Return the innermost line outside the engine and, where that is in a library, the calling line of the state."""
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
