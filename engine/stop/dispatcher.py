"""The logic of the relay's process: forwards STOP to every line and records which devices are at rest."""

from __future__ import annotations

import asyncio
import os
import signal
import socket
from collections import deque
from collections.abc import Callable
from dataclasses import dataclass
from typing import Literal

from engine.stop.outbox import Outbox
from engine.stop.relay_messages import (
    CloseRelay,
    DeviceStop,
    EngineProbe,
    FromRelay,
    MessageReader,
    NewStopLine,
    ProbeReply,
    RelayReady,
    RelaySettings,
    StopAcknowledgement,
    StopCommand,
    StopCommandReply,
    StopNotice,
    StopRelease,
    StopStatus,
    ToDevice,
    ToRelay,
    encode_message,
)

_READ_BYTES = 65536
_MAX_DESCRIPTORS = 16
PROBE_TIMEOUT_S = 0.1
"""Time limit of the engine's reply to a probe; after that, a signal stops the lines."""
ENGINE_TIMEOUT_S = 0.05
"""Time that the response to STOP waits for the engine; a later reply appears in the status."""
ACKNOWLEDGE_S = 0.2
"""Time that the response to STOP waits for the devices."""
LINGER_S = 5.0
"""Time during which STOP is still served after the engine's process has ended."""
_SIGNALS = (signal.SIGINT, signal.SIGTERM)
_Source = Literal["http", "engine", "signal", "loss"]


@dataclass(kw_only=True)
class _Line:
    """The relay's end of one stop line."""

    device: str
    connection: socket.socket
    reader: MessageReader
    connected: bool = True
    acknowledged: int = 0
    at_rest: int = 0


class StopDispatcher:
    """Numbers the stops, notifies lines and engine, and stores their replies.

    Args:
        engine: The socket to the engine, which also carries file descriptors.
        signals: Receives one byte, the number, for every signal that the engine's process catches, at once, also
            while its interpreter is blocked.
    """

    def __init__(self, engine: socket.socket, signals: socket.socket) -> None:
        self._loop = asyncio.get_running_loop()
        self._engine = engine
        self._engine_reader = MessageReader(ToRelay)
        self._to_engine = Outbox(engine)
        self._signals = signals
        self._descriptors: deque[int] = deque()
        self._lines: dict[str, _Line] = {}
        self._latest = StopNotice(stop=0, reason="", source="engine")
        self._since_s = 0.0
        self._probes = 0
        self._answered = 0
        self._probe_of_stop = 0
        self._changed = asyncio.Event()
        self._engine_ended = False
        self._stops_at_signals = False
        self._stopping: set[asyncio.Task[None]] = set()
        self.token = ""
        self.origins: frozenset[str] = frozenset()
        self.over: asyncio.Future[None] = self._loop.create_future()

    def begin(self) -> None:
        """Start reading from engine and signals."""
        for source, read in ((self._engine, self._read_engine), (self._signals, self._read_signals)):
            source.setblocking(False)
            self._loop.add_reader(source.fileno(), read)
        self._send_to_engine(RelayReady())

    def stop(self, reason: str, source: _Source) -> int:
        """Send the stop to every line and the engine, and return its number."""
        self._since_s = self._loop.time()
        notice = self._latest = StopNotice(stop=self._latest.stop + 1, reason=reason, source=source)
        for line in self._lines.values():
            self._send_to_line(line, notice)
        if source != "engine":
            self._send_to_engine(notice)
        self._probe_of_stop = self._probe_engine()
        return notice.stop

    async def stopped(self, reason: str, source: _Source = "http") -> StopStatus:
        """Stop, and return the status once all devices have acknowledged and the engine has replied, or are late."""
        number = self.stop(reason, source)
        await self._until(lambda: self._engine_informed, self._since_s + ENGINE_TIMEOUT_S)
        await self._until(
            lambda: self.status().acknowledged or self._latest.stop != number, self._since_s + ACKNOWLEDGE_S
        )
        return self.status()

    def status(self) -> StopStatus:
        """Return the status of the latest stop."""
        number = self._latest.stop
        devices = tuple(
            DeviceStop(
                name=line.device,
                connected=line.connected,
                acknowledged=line.acknowledged >= number,
                at_rest=line.at_rest >= number,
            )
            for line in self._lines.values()
        )
        engine = "ended" if self._engine_ended else ("informed" if self._engine_informed else "silent")
        return StopStatus(
            stop=number,
            reason=self._latest.reason,
            acknowledged=number > 0 and all(device.acknowledged or not device.connected for device in devices),
            at_rest=number > 0 and all(device.at_rest or not device.connected for device in devices),
            engine=engine,
            after_s=round(self._loop.time() - self._since_s, 4) if number else 0.0,
            devices=devices,
        )

    @property
    def _engine_informed(self) -> bool:
        return not self._engine_ended and self._answered >= self._probe_of_stop

    async def _until(self, done: Callable[[], bool], deadline_s: float) -> None:
        while not done():
            self._changed.clear()
            try:
                async with asyncio.timeout_at(deadline_s):
                    await self._changed.wait()
            except TimeoutError:
                return

    def _read_engine(self) -> None:
        try:
            data, descriptors, _, _ = socket.recv_fds(self._engine, _READ_BYTES, _MAX_DESCRIPTORS)
        except BlockingIOError:
            return
        except OSError:
            data, descriptors = b"", []
        self._descriptors.extend(descriptors)
        if not data:
            self._engine_lost()
            return
        for message in self._engine_reader.feed(data):
            self._take(message)

    def _take(self, message: object) -> None:
        match message:
            case RelaySettings():
                self.token, self.origins = message.token, frozenset(message.origins)
                self._stops_at_signals = message.stops_at_signals
            case NewStopLine():
                self._add_line(message.device, socket.socket(fileno=self._descriptors.popleft()))
            case StopCommand():
                stop = self.stop(message.reason, "engine")
                self._send_to_engine(StopCommandReply(stop=stop, request=message.request))
            case StopRelease():
                for line in self._lines.values():
                    self._send_to_line(line, message)
            case ProbeReply():
                self._answered = max(self._answered, message.number)
                self._changed.set()
            case CloseRelay():
                self._end()
            case _:
                pass

    def _add_line(self, device: str, connection: socket.socket) -> None:
        """Add a line; it replaces a line of the same device whose process has ended."""
        previous = self._lines.pop(device, None)
        if previous is not None and previous.connected:
            self._cut(previous)
        connection.setblocking(False)
        line = self._lines[device] = _Line(
            device=device, connection=connection, reader=MessageReader(StopAcknowledgement)
        )
        self._loop.add_reader(connection.fileno(), self._read_line, line)

    def _read_line(self, line: _Line) -> None:
        messages, is_over = line.reader.receive(line.connection)
        for message in messages:
            if isinstance(message, StopAcknowledgement):
                line.acknowledged = max(line.acknowledged, message.stop)
                line.at_rest = max(line.at_rest, message.stop if message.at_rest else 0)
        if is_over:
            self._cut(line)
        self._changed.set()

    def _cut(self, line: _Line) -> None:
        line.connected = False
        self._loop.remove_reader(line.connection.fileno())
        line.connection.close()
        self._changed.set()

    def _read_signals(self) -> None:
        try:
            numbers = self._signals.recv(_READ_BYTES)
        except OSError:
            return
        if not numbers:
            self._loop.remove_reader(self._signals.fileno())
        for number in numbers:
            if number in _SIGNALS:
                self._take_signal(f"interrupted by {signal.Signals(number).name}")

    def _take_signal(self, reason: str) -> None:
        if self._stops_at_signals:
            stopping = asyncio.create_task(self._stop_and_report(reason))
            self._stopping.add(stopping)
            stopping.add_done_callback(self._stopping.discard)
        else:
            self._loop.call_later(PROBE_TIMEOUT_S, self._stop_unless_answered, self._probe_engine(), reason)

    async def _stop_and_report(self, reason: str) -> None:
        status = await self.stopped(reason, "signal")
        silent = [device.name for device in status.devices if not device.acknowledged]
        if silent:
            _write_stderr(f"STOP is not acknowledged by {', '.join(silent)}")
        elif status.devices:
            _write_stderr(f"STOP acknowledged after {1e3 * status.after_s:.0f} ms")

    def _stop_unless_answered(self, probe: int, reason: str) -> None:
        if self._answered < probe and not self._engine_ended:
            self.stop(f"{reason}; the engine does not answer", "signal")
            _write_stderr("the engine does not answer: its robots are stopped without it")

    def _engine_lost(self) -> None:
        self._loop.remove_reader(self._engine.fileno())
        self._to_engine.close()
        self._engine_ended = True
        self.stop("the engine has ended", "loss")
        self._loop.call_later(LINGER_S, self._end)

    def _probe_engine(self) -> int:
        self._probes += 1
        self._send_to_engine(EngineProbe(number=self._probes))
        return self._probes

    def _send_to_engine(self, message: FromRelay) -> None:
        if not self._engine_ended:
            self._to_engine.send(encode_message(message))

    def _send_to_line(self, line: _Line, message: ToDevice) -> None:
        if not line.connected:
            return
        try:
            line.connection.send(encode_message(message))
        except OSError:
            self._cut(line)

    def _end(self) -> None:
        if not self.over.done():
            self.over.set_result(None)


def _write_stderr(line: str) -> None:
    os.write(2, f"flexcell: {line}\n".encode())
