"""Downloads trajectories and requests stops in a thread of its own; a stop overtakes a download.

While a motion is armed, the thread requests the stop by itself as soon as the event loop is silent for too long. It
connects only when it is asked to, and repeats nothing.
"""

from __future__ import annotations

import asyncio
import select
import socket
import threading
import time
from collections.abc import Callable, Sequence
from contextlib import suppress
from dataclasses import dataclass
from typing import Protocol

from engine.errors import RobotError
from robots.drivers.abb.abb_faults import REMEDIES, AbbFault, AbbLinkError
from robots.drivers.abb.simple_message import (
    JOINTS,
    STOP,
    ByteOrder,
    ReplyCode,
    SimpleMessageCodec,
    TrajectoryPoint,
)
from robots.drivers.abb.state_transport import connected
from robots.io.wire.link_error import LinkError
from robots.io.wire.tcp_connection import TcpConnection
from robots.io.wire.wire_tap import NO_TAP, WireTap

_POLL_S = 0.05
_JOIN_S = 5.0
_READ_BYTES = 4096
_STOP_POINT = TrajectoryPoint(sequence=STOP, joints_rad=(0.0,) * JOINTS, duration_s=0.0)

Done = asyncio.Future[float]
"""Has the time, on the monotonic clock, of the reply to the last request."""


class MotionLinkListener(Protocol):
    """Hears of the motion port on the event loop."""

    def motion_link_lost(self, reason: str) -> None:
        """Note that nothing can be commanded; the robot may still be moving."""
        ...

    def stopped_by_silence(self, silent_s: float) -> None:
        """Note that the stop was requested: the event loop was silent while a motion was armed."""
        ...


@dataclass(frozen=True)
class _Download:
    points: Sequence[TrajectoryPoint]
    done: Done
    stops: int


class MotionLink:
    """The motion port of one controller.

    Args:
        host: Where the controller is.
        port: Its motion port.
        listener: Called on the event loop.
        byte_order: Of all numbers.
        timeout_s: Time limit of each reply.
        silence_s: Silence of the event loop after which an armed motion is stopped.
        tap: Notes the bytes of the connection.
    """

    def __init__(
        self,
        host: str,
        port: int,
        listener: MotionLinkListener,
        *,
        byte_order: ByteOrder,
        timeout_s: float,
        silence_s: float,
        tap: WireTap = NO_TAP,
    ) -> None:
        self._where = (host, port)
        self._listener = listener
        self._codec = SimpleMessageCodec(byte_order)
        self._timeout_s = timeout_s
        self._silence_s = silence_s
        self._tap = tap
        self._loop = asyncio.get_running_loop()
        self._lock = threading.Lock()
        self._downloads: list[_Download] = []
        self._stops: list[Done] = []
        self._connects: list[Done] = []
        self._stop_count = 0
        self._unconfirmed: list[Done] = []
        self._unanswered = 0
        self._closing = False
        self._armed = False
        self._loop_alive_s = 0.0
        self._socket: TcpConnection | None = None
        self._received = bytearray()
        self._bell, self._button = socket.socketpair()
        # The event loop does not wait for a thread that does not listen: its bell rings already, or never again.
        self._button.setblocking(False)
        self._thread = threading.Thread(target=self._work, name=f"motion link {self.address}", daemon=True)
        self._thread.start()

    @property
    def address(self) -> str:
        """Host and port."""
        return f"{self._where[0]}:{self._where[1]}"

    def connect(self) -> Done:
        """Connect anew and request a stop, whose reply shows that the motion server serves this client."""
        return self._ask(self._connects.append)

    def download(self, points: Sequence[TrajectoryPoint]) -> Done:
        """Send a trajectory, which its last point starts; a stop that is requested meanwhile ends the download."""
        return self._ask(lambda done: self._downloads.append(_Download(points, done, self._stop_count)))

    def stop(self) -> Done:
        """Request a stop; it overtakes downloads, whose futures then fail."""

        def put(done: Done) -> None:
            self._stop_count += 1
            self._stops.append(done)

        return self._ask(put)

    def arm(self, *, armed: bool) -> None:
        """Set whether the thread requests a stop when the event loop is silent."""
        self._loop_alive_s = time.monotonic()
        self._armed = armed
        self._ring()

    async def close(self) -> None:
        """End the thread and disconnect."""
        self._closing = True
        self._ring()
        await asyncio.to_thread(self._thread.join, _JOIN_S)
        self._bell.close()
        self._button.close()

    def _ask(self, put: Callable[[Done], None]) -> Done:
        done: Done = self._loop.create_future()
        if self._closing:
            done.set_exception(RobotError("disconnected", where=self.address))
            return done
        with self._lock:
            put(done)
        self._ring()
        return done

    def _ring(self) -> None:
        with suppress(OSError):  # full: it rings already; closed: the thread has ended
            self._button.send(b"\0")

    def _work(self) -> None:
        while not self._closing:
            try:
                self._turn()
            except LinkError as error:
                self._lose(error)
            except Exception as error:
                # A defect of this thread must not look like a link that is merely quiet.
                self._closing = True
                self._lose(LinkError(f"the driver failed: {type(error).__name__}: {error}"))
                raise
        with suppress(LinkError):  # its request fails below, and says that it was not confirmed
            self._send_last_stop()
        self._disconnect()
        self._fail_all("disconnected")

    def _send_last_stop(self) -> None:
        """Send a stop that was requested just before the link was closed."""
        if self._stops and self._socket is not None:
            self._send_stop()
            self._collect()

    def _turn(self) -> None:
        """Do what was asked for, stops before downloads; else wait."""
        with self._lock:
            connects, self._connects = self._connects, []
            stops = bool(self._stops)
            download = self._downloads.pop(0) if self._downloads and not connects and not stops else None
        if connects:
            self._reconnect(connects)
        elif stops:
            self._send_stop()
            self._collect()
        elif download is not None:
            self._send_download(download)
        else:
            self._watch_loop()
            self._collect()
            self._wait(_POLL_S if self._armed else None)
            if self._received:
                raise AbbLinkError(AbbFault.GARBAGE, f"bytes that are no reply: {self._received[:16].hex(' ')}")

    def _reconnect(self, connects: list[Done]) -> None:
        self._disconnect()
        try:
            self._socket = connected(self._where, self._timeout_s, self._tap)
            self._send(_STOP_POINT)
            self._collect()
        except LinkError as error:
            self._disconnect()
            for done in connects:
                self._finish(done, error=error)
            return
        for done in connects:
            self._finish(done)

    def _send_download(self, download: _Download) -> None:
        try:
            for point in download.points:
                if self._closing or self._stop_count != download.stops:
                    raise LinkError("the download was stopped")
                self._send(point)
                self._collect()
        except LinkError as error:
            self._finish(download.done, error=error)
            if self._stop_count == download.stops or isinstance(error, AbbLinkError):
                raise
            return
        self._finish(download.done)

    def _send_stop(self) -> None:
        with self._lock:
            stops, self._stops = self._stops, []
        self._unconfirmed += stops
        self._send(_STOP_POINT)

    def _send(self, point: TrajectoryPoint) -> None:
        if self._socket is None:
            raise AbbLinkError(AbbFault.LINK_CUT, "the motion port is not connected")
        frame = self._codec.encode_point(point)
        try:
            self._socket.set_timeout(self._timeout_s)
            self._socket.send(frame)
        except OSError as error:
            raise AbbLinkError(AbbFault.LINK_CUT, f"the motion connection failed: {error.strerror or error}") from error
        self._unanswered += 1

    def _collect(self) -> None:
        """Take the replies to all requests; a stop that is asked for meanwhile is sent at once."""
        limit_s = time.monotonic() + self._timeout_s
        while self._unanswered:
            if self._stops:
                self._send_stop()
            left_s = limit_s - time.monotonic()
            if left_s <= 0.0:
                raise AbbLinkError(AbbFault.SILENT, f"no reply within {self._timeout_s:g} s")
            self._watch_loop()
            self._wait(min(left_s, _POLL_S))
            for frame in self._codec.split(self._received):
                if self._codec.decode_reply(frame) is ReplyCode.FAILURE:
                    raise AbbLinkError(AbbFault.REFUSED, "the controller replied with failure")
                self._unanswered -= 1
        confirmed, self._unconfirmed = self._unconfirmed, []
        for done in confirmed:
            self._finish(done)

    def _wait(self, limit_s: float | None) -> None:
        """Wait for bytes, or for something to do."""
        connection = self._socket
        sources = [self._bell] if connection is None else [self._bell, connection]
        ready, _, _ = select.select(sources, [], [], limit_s)
        if self._bell in ready:
            self._bell.recv(_READ_BYTES)
        if connection is None or connection not in ready:
            return
        try:
            packet = connection.receive(_READ_BYTES)
        except OSError as error:
            raise AbbLinkError(AbbFault.LINK_CUT, f"the motion connection failed: {error.strerror or error}") from error
        if not packet:
            raise AbbLinkError(AbbFault.LINK_CUT, "the controller closed the motion connection")
        self._received += packet

    def _watch_loop(self) -> None:
        """Request a stop where the event loop has not answered for too long."""
        if not self._armed:
            return
        silent_s = time.monotonic() - self._loop_alive_s
        if silent_s > self._silence_s:
            self._armed = False
            with self._lock:
                self._stop_count += 1
            self._send(_STOP_POINT)
            self._post(lambda: self._listener.stopped_by_silence(silent_s))
        else:
            self._post(self._mark_alive)

    def _mark_alive(self) -> None:
        self._loop_alive_s = time.monotonic()

    def _lose(self, error: LinkError) -> None:
        was_connected = self._socket is not None
        self._disconnect()
        self._armed = False
        self._fail_all(str(error))
        if was_connected or self._closing:
            self._post(lambda: self._listener.motion_link_lost(str(error)))

    def _disconnect(self) -> None:
        if self._socket is not None:
            self._socket.close()
        self._socket = None
        self._received.clear()
        self._unanswered = 0

    def _fail_all(self, reason: str) -> None:
        with self._lock:
            waiting = [*self._unconfirmed, *self._stops, *(each.done for each in self._downloads), *self._connects]
            self._unconfirmed, self._stops, self._downloads, self._connects = [], [], [], []
        for done in waiting:
            self._finish(done, error=LinkError(reason))

    def _finish(self, done: Done, *, error: LinkError | None = None) -> None:
        at_s = time.monotonic()

        def finish() -> None:
            if done.done():
                return
            if error is None:
                done.set_result(at_s)
                return
            hint = REMEDIES[error.fault] if isinstance(error, AbbLinkError) else REMEDIES[AbbFault.LINK_CUT]
            done.set_exception(RobotError(str(error), where=self.address, hint=hint))

        self._post(finish)

    def _post(self, callback: Callable[[], None]) -> None:
        # The loop may have ended before the link was closed: then nobody is left to hear of it.
        if not self._loop.is_closed():
            self._loop.call_soon_threadsafe(callback)
