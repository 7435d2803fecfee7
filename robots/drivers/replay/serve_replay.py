"""Serves the device's side of a capture on TCP, a pty, or UDP, until it is cancelled."""

from __future__ import annotations

import asyncio
import logging
from collections.abc import Callable, Generator, Mapping, Sequence
from contextlib import contextmanager
from pathlib import Path

from engine.cell.drivers import Ready
from engine.errors import FlexcellError
from robots.drivers.emulation.byte_stream import PtyStream, TcpStream
from robots.drivers.emulation.serve_emulator import execute_wire_fault, serve_emulator
from robots.drivers.emulation.side_channel import Request, SideChannel
from robots.drivers.emulation.wire_faults import WireFaults
from robots.drivers.replay.capture_replay import CaptureReplay, RecordedReply, ReplayMismatch
from robots.drivers.replay.datagram_replay import DatagramReplay
from robots.drivers.replay.egm_replay import EgmReplay
from robots.drivers.replay.hand_states import HandStateReplay
from robots.drivers.replay.replay_emulator import ReplayOptions
from robots.drivers.replay.request_rules import NOT_REPLAYED, REQUEST_RULES, STRICT
from robots.io.wire.read_capture import CapturedConnection, read_capture

_log = logging.getLogger("flexcell.devices")


class ReplayServer:
    """Implements `ProtocolSession` for all connections; replies keep their recorded delays and their order.

    `send` and `end` reach the driver; they are those of the stream, which needs this session first.

    Args:
        replay: What answers.
        pace: Share of the recorded delays.
    """

    def __init__(self, replay: CaptureReplay, *, pace: float) -> None:
        self._replay = replay
        self._pace = pace
        self._due_s = 0.0
        self._timers: list[asyncio.TimerHandle] = []
        self.send: Callable[[bytes], None] = lambda _: None
        self.end: Callable[[], None] = lambda: None
        self.taken: Callable[[bytes], None] = lambda _: None
        """Called with the bytes of requests that are as recorded."""
        self.mismatch = ""

    def begin(self) -> None:
        """Begin the next opening of the capture."""
        for timer in self._timers:
            timer.cancel()
        self._timers.clear()
        self._due_s = 0.0
        self._schedule(self._replay.open())

    def feed(self, received: bytes) -> bytes:
        """Take bytes; the replies follow in their time."""
        if self.mismatch:
            return b""
        try:
            answered = self._replay.answered
            self._schedule(self._replay.feed(received))
            if self._replay.answered > answered:
                self.taken(received)
        except ReplayMismatch as error:
            self.mismatch = str(error)
            _log.warning("the driver does not do what was recorded: %s", error)
            self.end()
        return b""

    def state(self) -> Mapping[str, object]:
        """Return what was replayed, and why no more."""
        return {
            "mismatch": self.mismatch,
            "answered": self._replay.answered,
            "repeated": self._replay.repeated,
            "remaining_commands": self._replay.remaining_commands,
        }

    def _schedule(self, replies: Sequence[RecordedReply]) -> None:
        loop = asyncio.get_running_loop()
        now_s = loop.time()
        for reply in replies:
            self._due_s = max(self._due_s, now_s + self._pace * reply.delay_s)
            if self._due_s <= now_s and not reply.ends:
                self.send(reply.data)
            elif reply.ends:
                self._timers.append(loop.call_at(self._due_s, self.end))
            else:
                self._timers.append(loop.call_at(self._due_s, self.send, reply.data))
        self._timers = [timer for timer in self._timers if timer.when() > now_s and not timer.cancelled()]


async def serve_replay(options: ReplayOptions, ready: Ready) -> None:
    """Serve until this is cancelled; `ready` receives where.

    Raises:
        FlexcellError: no capture is named, it cannot be read, or it is not one of a client.
    """
    if not options.file:
        raise FlexcellError("name the capture", hint="flexcell emulate replay file=FILE")
    captured = read_capture(Path(options.file))
    if captured.protocol in NOT_REPLAYED:
        reason, hint = NOT_REPLAYED[captured.protocol]
        raise FlexcellError(reason, where=options.file, hint=hint)
    if captured.transport == "udp":
        await _serve_datagrams(captured, options, ready)
        return
    rule = REQUEST_RULES.get(captured.protocol, STRICT)
    server = ReplayServer(CaptureReplay(captured, rule), pace=options.pace)
    faults = WireFaults()
    if captured.transport == "serial":
        stream: PtyStream | TcpStream = PtyStream(lambda: server, faults)
    else:
        stream = tcp = TcpStream(lambda: server, faults, host=options.host, port=options.port)
        tcp.when_connected(server.begin)
        server.end = tcp.drop_clients
    server.send = stream.send

    async def execute(request: Request) -> Mapping[str, object]:
        if request["do"] == "state":
            return server.state()
        await execute_wire_fault(request, faults, stream)
        return {"ok": True}

    connection = "serial" if captured.transport == "serial" else captured.protocol
    with _states_of(captured, options, server):
        await serve_emulator(
            stream, execute, ready, connection=connection, host=options.host, side_port=options.side_port
        )


@contextmanager
def _states_of(captured: CapturedConnection, options: ReplayOptions, server: ReplayServer) -> Generator[None]:
    """Send the states of a Franka Hand with its replies."""
    if captured.protocol != "hand_commands":
        yield
        return
    if not options.states:
        reason, hint = NOT_REPLAYED["hand_states"]
        raise FlexcellError(f"{reason}: those of this capture are missing", where=options.file, hint=hint)
    states = HandStateReplay(
        read_capture(Path(options.states)), captured, receiver=options.receiver or "127.0.0.1", pace=options.pace
    )
    server.taken = states.take
    try:
        yield
    finally:
        states.close()


async def _serve_datagrams(captured: CapturedConnection, options: ReplayOptions, ready: Ready) -> None:
    recorded = next(
        (each.endpoints.local[0] for each in captured.events if each.kind == "received" and each.endpoints), ""
    )
    if recorded and not options.receiver:
        # Whoever has that address now does not expect them.
        raise FlexcellError(
            f"the datagrams of this capture would be sent to {recorded}, the recorded client",
            where=options.file,
            hint="name who receives them, for a client on this machine: receiver=127.0.0.1",
        )
    new_replay = EgmReplay if captured.protocol == "egm" else DatagramReplay
    replay = new_replay(captured, host=options.host, receiver=options.receiver, pace=options.pace)

    async def execute(request: Request) -> Mapping[str, object]:
        if request["do"] != "state":
            raise ValueError(f"{request['do']} is not known")
        return replay.state()

    side = SideChannel(execute, host=options.host, port=options.side_port)
    with replay:
        place = {"connection": captured.protocol, "host": options.host, "ports": replay.ports}
        ready({**place, "side_port": await side.open()})
        try:
            await asyncio.Event().wait()
        finally:
            side.close()
