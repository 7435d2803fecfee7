"""What the relay's process knows and does: it passes STOP on to every line, and keeps who has come to rest."""

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
GRACE_S = 0.1
"""How long the engine may take to answer a question; the lines are told of a signal after that."""
NOTE_S = 0.05
"""How long an answer to STOP waits for the engine; a later one finds it in the status."""
ACKNOWLEDGE_S = 0.2
"""How long an answer to STOP waits for the devices."""
LINGER_S = 5.0
"""How long STOP is still answered after the engine has died."""
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
    """Counts the stops, tells lines and engine, and keeps what they answer.

    Args:
        engine: The socket to the engine, which descriptors come through.
        signals: Gets a byte with its number for every signal that the engine's process catches, at once, also
            while its interpreter is held.
    """

    def __init__(self, engine: socket.socket, signals: socket.socket) -> None:
        self._loop = asyncio.get_running_loop()
        self._engine = engine
        self._engine_reader = MessageReader(ToRelay)
        self._to_engine = Outbox(engine)
        self._signals = signals
        self._descriptors: deque[int] = deque()
        self._lines: dict[str, _Line] = {}
        self._newest = StopNotice(stop=0, reason="", source="engine")
        self._since_s = 0.0
        self._questions = 0
        self._answered = 0
        self._asked_for_stop = 0
        self._changed = asyncio.Event()
        self._engine_ended = False
        self._stops_at_signals = False
        self._stopping: set[asyncio.Task[None]] = set()
        self.token = ""
        self.origins: frozenset[str] = frozenset()
        self.over: asyncio.Future[None] = self._loop.create_future()

    def begin(self) -> None:
        """Listen to engine and signals."""
        for source, read in ((self._engine, self._read_engine), (self._signals, self._read_signals)):
            source.setblocking(False)
            self._loop.add_reader(source.fileno(), read)
        self._tell_engine(RelayReady())

    def stop(self, reason: str, source: _Source) -> int:
        """Tell every line and the engine to stop, and return the stop's number."""
        self._since_s = self._loop.time()
        notice = self._newest = StopNotice(stop=self._newest.stop + 1, reason=reason, source=source)
        for line in self._lines.values():
            self._tell(line, notice)
        if source != "engine":
            self._tell_engine(notice)
        self._asked_for_stop = self._ask_engine()
        return notice.stop

    async def stopped(self, reason: str, source: _Source = "http") -> StopStatus:
        """Stop, and return the status once all have acknowledged and the engine was heard, or is late."""
        number = self.stop(reason, source)
        await self._until(lambda: self._engine_informed, self._since_s + NOTE_S)
        await self._until(
            lambda: self.status().acknowledged or self._newest.stop != number, self._since_s + ACKNOWLEDGE_S
        )
        return self.status()

    def status(self) -> StopStatus:
        """Return how far the newest stop is."""
        number = self._newest.stop
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
            reason=self._newest.reason,
            acknowledged=number > 0 and all(device.acknowledged or not device.connected for device in devices),
            at_rest=number > 0 and all(device.at_rest or not device.connected for device in devices),
            engine=engine,
            after_s=round(self._loop.time() - self._since_s, 4) if number else 0.0,
            devices=devices,
        )

    @property
    def _engine_informed(self) -> bool:
        return not self._engine_ended and self._answered >= self._asked_for_stop

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
                self._tell_engine(StopCommandReply(stop=stop, request=message.request))
            case StopRelease():
                for line in self._lines.values():
                    self._tell(line, message)
            case ProbeReply():
                self._answered = max(self._answered, message.number)
                self._changed.set()
            case CloseRelay():
                self._end()
            case _:
                pass

    def _add_line(self, device: str, connection: socket.socket) -> None:
        """Keep a line; one of the same device, of a process that is gone, makes room for it."""
        before = self._lines.pop(device, None)
        if before is not None and before.connected:
            self._cut(before)
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
            stopping = asyncio.create_task(self._stop_and_say(reason))
            self._stopping.add(stopping)
            stopping.add_done_callback(self._stopping.discard)
        else:
            self._loop.call_later(GRACE_S, self._stop_unless_answered, self._ask_engine(), reason)

    async def _stop_and_say(self, reason: str) -> None:
        status = await self.stopped(reason, "signal")
        silent = [device.name for device in status.devices if not device.acknowledged]
        if silent:
            _say(f"STOP is not acknowledged by {', '.join(silent)}")
        elif status.devices:
            _say(f"STOP acknowledged after {1e3 * status.after_s:.0f} ms")

    def _stop_unless_answered(self, question: int, reason: str) -> None:
        if self._answered < question and not self._engine_ended:
            self.stop(f"{reason}; the engine does not answer", "signal")
            _say("the engine does not answer: its robots were told to come to rest without it")

    def _engine_lost(self) -> None:
        self._loop.remove_reader(self._engine.fileno())
        self._to_engine.close()
        self._engine_ended = True
        self.stop("the engine has ended", "loss")
        self._loop.call_later(LINGER_S, self._end)

    def _ask_engine(self) -> int:
        self._questions += 1
        self._tell_engine(EngineProbe(number=self._questions))
        return self._questions

    def _tell_engine(self, message: FromRelay) -> None:
        if not self._engine_ended:
            self._to_engine.send(encode_message(message))

    def _tell(self, line: _Line, message: ToDevice) -> None:
        if not line.connected:
            return
        try:
            line.connection.send(encode_message(message))
        except OSError:
            self._cut(line)

    def _end(self) -> None:
        if not self.over.done():
            self.over.set_result(None)


def _say(line: str) -> None:
    os.write(2, f"flexcell: {line}\n".encode())
