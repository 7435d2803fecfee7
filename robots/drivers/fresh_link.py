"""Reads a device in a thread of its own, and knows how fresh each reading is.

A lost connection is opened again for reading only: no command is kept or repeated. While a motion is armed, the thread
sends its stop command as soon as the event loop is silent for too long, until that has succeeded.
"""

from __future__ import annotations

import asyncio
import threading
import time
from collections import deque
from collections.abc import Callable
from dataclasses import dataclass
from typing import Generic, Protocol, TypeVar

from engine.errors import RobotError
from robots.drivers.device_transport import DeviceTransport
from robots.drivers.finite_values import non_finite_value
from robots.io.wire.link_error import LinkError

R = TypeVar("R")
C = TypeVar("C")
_RETRY_S = 0.2
_JOIN_S = 5.0


@dataclass(frozen=True, kw_only=True)
class FreshReading(Generic[R]):
    """A reading with the time at which it was requested, on the monotonic clock, and how long the answer took."""

    value: R
    asked_s: float
    took_s: float


class LinkListener(Protocol[R]):
    """Hears of a device on the event loop."""

    def read(self, reading: FreshReading[R]) -> None:
        """Take a reading."""
        ...

    def lost(self, reason: str) -> None:
        """Note that no reading is fresh any more."""
        ...

    def found(self) -> None:
        """Note that readings are fresh again."""
        ...

    def stopped_by_silence(self, silent_s: float) -> None:
        """Note that the stop command was sent: the event loop was silent while a motion was armed."""
        ...


@dataclass(frozen=True, kw_only=True)
class LinkTiming:
    """Seconds: between readings, until one is stale, and of silence of the event loop until a motion is stopped."""

    period_s: float = 0.02
    stale_s: float = 0.5
    silence_s: float = 0.3


class FreshLink(Generic[R, C]):
    """One device behind one transport.

    Args:
        transport: Used by the thread of this link only.
        listener: Called on the event loop.
        timing: Its times.
    """

    def __init__(self, transport: DeviceTransport[R, C], listener: LinkListener[R], timing: LinkTiming) -> None:
        self.transport = transport
        self.timing = timing
        self.latest: FreshReading[R] | None = None
        """The last reading; assigned by the thread."""
        self.lost_reason = ""
        self._last_error = ""
        self._listener = listener
        self._loop = asyncio.get_running_loop()
        self._queue: deque[tuple[C, asyncio.Future[float]]] = deque()
        self._wake = threading.Event()
        self._closing = False
        self._stop_command: C | None = None
        self._loop_alive_s = 0.0
        self._thread = threading.Thread(target=self._work, name=f"link {transport.address}", daemon=True)
        self._first: asyncio.Future[None] = self._loop.create_future()

    async def start(self) -> None:
        """Connect and return with the first reading; one that fails, or is cancelled, is closed.

        Raises:
            RobotError: the device does not answer; the message says where, the hint what to check.
        """
        self._thread.start()
        try:
            await self._first
        except BaseException:
            # The thread must not outlive this call.
            await self.close()
            raise

    async def close(self) -> None:
        """End the thread and disconnect."""
        self._closing = True
        self._wake.set()
        if self._thread.is_alive():
            await asyncio.to_thread(self._thread.join, _JOIN_S)

    def age_s(self) -> float:
        """Return the age of the last reading; infinite without one."""
        return time.monotonic() - self.latest.asked_s if self.latest is not None else float("inf")

    def fresh(self) -> R:
        """Return the last reading.

        Raises:
            RobotError: it is stale; says for how long.
        """
        latest, age_s = self.latest, self.age_s()
        if latest is None or self.lost_reason or age_s > self.timing.stale_s:
            cause = f"{self._last_error}; " if self._last_error else ""
            reason = self.lost_reason or f"{cause}no fresh reading for {age_s:.2f} s"
            raise RobotError(reason, where=self.transport.address, hint=self.transport.remedy)
        return latest.value

    def submit(self, command: C) -> asyncio.Future[float]:
        """Send a command before the next reading; the future has the time of its acknowledgement.

        A command that fails is not repeated, and none is kept while the device does not answer.
        """
        written: asyncio.Future[float] = self._loop.create_future()
        if self.lost_reason or self._closing:
            written.set_exception(RobotError(self.lost_reason or "disconnected", where=self.transport.address))
        else:
            self._queue.append((command, written))
            self._wake.set()
        return written

    def arm(self, stop_command: C | None) -> None:
        """Set what the thread sends when the event loop is silent; None for nothing."""
        self._loop_alive_s = time.monotonic()
        self._stop_command = stop_command

    def _work(self) -> None:
        try:
            self._exchange()
        except Exception as error:
            # A defect of a transport or library must not look like a device that is merely quiet.
            self.lost_reason = f"the driver failed: {type(error).__name__}: {error}"
            self._closing = True
            self._fail_all(self.lost_reason)
            self._post(lambda: self._refuse_start(self.lost_reason))
            self._post(lambda: self._listener.lost(self.lost_reason))
            raise
        finally:
            self.transport.close()

    def _exchange(self) -> None:
        opened = False
        begun_s = good_s = time.monotonic()
        while not self._closing:
            self._wake.clear()
            try:
                if not opened:
                    self.transport.open()
                    opened = True
                self._write_all()
                asked_s = time.monotonic()
                value = self._read()
                good_s = asked_s
                self._deliver(FreshReading(value=value, asked_s=asked_s, took_s=time.monotonic() - asked_s))
                self._watch_loop()
                self._wake.wait(max(0.0, self.timing.period_s - (time.monotonic() - asked_s)))
            except LinkError as error:
                self.transport.close()
                opened = False
                self._last_error = str(error)
                self._fail_all(str(error))
                if not self._failed_to_start(error, begun_s):
                    self._note_loss(str(error), good_s)
                if not self._closing:
                    self._wake.wait(min(_RETRY_S, self.timing.stale_s / 4.0))
        self._fail_all("disconnected")

    def _read(self) -> R:
        value = self.transport.read()
        # Before anybody sees it: not every protocol or library checks it.
        problem = non_finite_value(value)
        if problem:
            raise LinkError(f"invalid reading: {problem}")
        return value

    def _failed_to_start(self, error: LinkError, begun_s: float) -> bool:
        """Report a device that has never answered; true while it has not."""
        if self.latest is not None:
            return False
        if time.monotonic() - begun_s > self.timing.stale_s:
            self._closing = True
            self._post(lambda: self._refuse_start(str(error)))
        return True

    def _refuse_start(self, reason: str) -> None:
        if not self._first.done():
            self._first.set_exception(RobotError(reason, where=self.transport.address, hint=self.transport.remedy))

    def _note_loss(self, reason: str, good_s: float) -> None:
        silent_s = time.monotonic() - good_s
        if not self.lost_reason and silent_s > self.timing.stale_s:
            self.lost_reason = f"{reason}; no fresh reading for {silent_s:.2f} s"
            self._post(lambda: self._listener.lost(self.lost_reason))

    def _deliver(self, reading: FreshReading[R]) -> None:
        self.latest = reading
        self._last_error = ""
        if self.lost_reason:
            self.lost_reason = ""
            self._post(self._listener.found)
        self._post(lambda: self._heard(reading))

    def _heard(self, reading: FreshReading[R]) -> None:
        self._loop_alive_s = time.monotonic()
        self._listener.read(reading)
        if not self._first.done():
            self._first.set_result(None)

    def _watch_loop(self) -> None:
        command, silent_s = self._stop_command, time.monotonic() - self._loop_alive_s
        if command is not None and silent_s > self.timing.silence_s:
            self.transport.write(command)
            # Not before: a stop that fails is due on the next connection, the only command that is.
            if self._stop_command is command:
                self._stop_command = None
            self._post(lambda: self._listener.stopped_by_silence(silent_s))

    def _write_all(self) -> None:
        while self._queue:
            command, written = self._queue.popleft()
            try:
                self.transport.write(command)
            except LinkError as error:
                self._finish(written, error=str(error))
                raise
            self._finish(written, at_s=time.monotonic())

    def _fail_all(self, reason: str) -> None:
        while self._queue:
            self._finish(self._queue.popleft()[1], error=reason)

    def _finish(self, written: asyncio.Future[float], *, at_s: float = 0.0, error: str = "") -> None:
        def finish() -> None:
            if written.done():
                return
            if error:
                written.set_exception(RobotError(error, where=self.transport.address, hint=self.transport.remedy))
            else:
                written.set_result(at_s)

        self._post(finish)

    def _post(self, callback: Callable[[], None]) -> None:
        # The loop may have ended before the device was closed: then nobody is left to hear of it.
        if not self._loop.is_closed():
            self._loop.call_soon_threadsafe(callback)
