"""A world in its own process, in real time: control keeps its deadlines while this process plans and serves."""

from __future__ import annotations

import asyncio
import os
import socket
import subprocess
from collections import deque
from collections.abc import Callable

import msgspec

from engine.errors import CONNECT_AGAIN, CellError, RobotError
from engine.host.child_process import describe_exit, start_child
from robots.io.framing import FrameReader, frame_message
from robots.port import Array
from robots.port.heartbeat import Heartbeat, new_heartbeat_file
from robots.port.loop_heartbeat import LoopHeartbeat
from robots.port.shared_file import new_shared_file
from robots.sim.commands.world_commands import AnyCommand, RestoreWorld, ShutDownWorld
from robots.sim.host.loop_timing import SIZE, LoopTiming, decode_timing
from robots.sim.host.shared_state import SharedNumbers
from robots.sim.host.world_host import WorldListener
from robots.sim.host.world_report import AnyReport, WorldReady, WorldRefused, WorldRestored
from robots.sim.loop.snapshot import CellSummary, SimSnapshot, SnapshotLayout
from robots.sim.scene.sim_scene import SimScene

_START = "from robots.sim.host.process_main import main; main()"
_WHAT = "the world's process"
# On a loaded machine that compiles the controllers for the first time, one arm takes half a minute.
_START_S = 180.0
_END_S = 6.0
# On an overloaded machine this takes seconds; a timeout too early makes a run impossible to resume.
_RESTORE_S = 20.0


NewStopLine = Callable[[str], socket.socket]
"""Makes the stop line of a device; see `engine.stop.StopRelay.new_line`."""


class ProcessHost:
    """Starts the process, sends commands, receives events and reads its state from shared memory.

    Args:
        scene: The scene of the world.
        new_stop_line: Creates the line on which the process receives STOP; None for a world without one.
    """

    def __init__(self, scene: SimScene, *, new_stop_line: NewStopLine | None = None) -> None:
        self._scene = scene
        self._new_stop_line = new_stop_line
        self._process: subprocess.Popen[bytes] | None = None
        self._wire: _Wire | None = None
        self._layout: SnapshotLayout | None = None
        self._state: SharedNumbers | None = None
        self._timing: SharedNumbers | None = None
        self._heartbeat: LoopHeartbeat | None = None
        self.fifo = False

    @property
    def summary(self) -> CellSummary:
        """Summary of the world."""
        return self._opened()[0].summary

    @property
    def pid(self) -> int:
        """The process id of the world."""
        return self._process.pid if self._process is not None else 0

    def timing(self) -> LoopTiming:
        """Return timing statistics since the world was opened."""
        if self._timing is None:
            raise _not_open()
        return decode_timing(self._timing.read())

    def snapshot(self) -> SimSnapshot:
        """Return the latest state, at most a few steps old; the last one after the process is lost."""
        layout, state = self._opened()
        return SimSnapshot(layout, state.read())

    def image(self) -> Array:
        """Return the latest complete state, at most a few steps old; the last one after the process is lost."""
        layout, state = self._opened()
        return state.read()[layout.size :]

    async def restore(self, image: Array) -> None:
        """Restore an image of this world; returns when the process has confirmed it."""
        self.send(RestoreWorld.of(image))
        assert self._wire is not None
        restored = self._wire.next_restored()
        try:
            async with asyncio.timeout(_RESTORE_S):
                await restored
        except TimeoutError as error:
            raise RobotError(
                f"the world's process did not restore its state within {_RESTORE_S:g} s", hint=CONNECT_AGAIN
            ) from error

    def send(self, command: AnyCommand) -> None:
        """Send a command; raises RobotError when the process is lost."""
        if self._wire is None or self._wire.lost_reason:
            raise RobotError(
                self._wire.lost_reason if self._wire else "the world's process was ended", hint=CONNECT_AGAIN
            )
        if self._heartbeat is not None:
            self._heartbeat.pulse()
        self._wire.send(msgspec.msgpack.encode(command))

    async def open(self, listener: WorldListener) -> None:
        """Start the process and wait until its world is built; may be called again after a loss."""
        ours, theirs = socket.socketpair()
        state_fd, timing_fd, heartbeat_fd = (
            new_shared_file("flexcell-state"),
            new_shared_file("flexcell-timing"),
            new_heartbeat_file(),
        )
        stop_line = self._new_stop_line("world") if self._new_stop_line is not None else None
        stop_fds = (stop_line.fileno(),) if stop_line is not None else ()
        descriptors = (theirs.fileno(), state_fd, timing_fd, heartbeat_fd, *stop_fds)
        try:
            self._process = start_child(_START, descriptors, what=_WHAT)
            # Closed before the process can end, else its end would not be noticed.
            theirs.close()
            loop = asyncio.get_running_loop()
            _, wire = await loop.create_connection(lambda: _Wire(listener, self._how_it_ended), sock=ours)
            self._wire = wire
            wire.send(msgspec.msgpack.encode(self._scene))
            ready = await self._answer(wire)
            self._layout = SnapshotLayout(ready.summary)
            self._state = SharedNumbers(state_fd, self._layout.size + ready.summary.image_size)
            # Read once, so that a consistent state exists if the process dies in mid-write.
            self._state.read()
            self._timing = SharedNumbers(timing_fd, SIZE)
            self.fifo = ready.fifo
            self._begin_heartbeat(Heartbeat(heartbeat_fd))
        except BaseException:
            # On any error, cancellation included, no process may be left behind.
            wire, self._wire = self._wire, None
            if wire is None:
                ours.close()
            else:
                wire.first.cancel()
            self._kill(wire)
            raise
        finally:
            theirs.close()
            if stop_line is not None:
                stop_line.close()
            os.close(state_fd)
            os.close(timing_fd)
            os.close(heartbeat_fd)

    def _begin_heartbeat(self, heartbeat: Heartbeat) -> None:
        self._heartbeat = LoopHeartbeat(
            heartbeat, limit_s=self._scene.world_silence_s, on_silence=self._end_silent_process
        )
        self._heartbeat.begin()

    def _end_silent_process(self, silent_s: float) -> None:
        """Kill a process that does not step, so that its end is certain, and report its loss."""
        if self._process is not None:
            self._process.kill()
        if self._wire is not None and not self._wire.lost_reason:
            self._wire.lose(f"{_WHAT} has not stepped for {silent_s:.1f} s: it is frozen or starved, and was killed")
            self._wire.close()

    async def _answer(self, wire: _Wire) -> WorldReady:
        try:
            async with asyncio.timeout(_START_S):
                answer = await asyncio.shield(wire.first)
        except TimeoutError as error:
            raise RobotError(f"the world's process did not answer within {_START_S:g} s") from error
        if isinstance(answer, WorldRefused):
            raise CellError(answer.message, where=answer.where or None, hint=answer.hint or None)
        return answer

    async def close(self) -> None:
        """Bring everything to rest and end the process; kill it if it does not end."""
        wire, self._wire = self._wire, None
        try:
            if wire is not None:
                wire.closing = True
                if not wire.lost_reason:
                    wire.send(msgspec.msgpack.encode(ShutDownWorld()))
                    await asyncio.wait((wire.gone,), timeout=_END_S)
        finally:
            # Even if this is cancelled while it waits, no process may be left behind.
            self._kill(wire)

    def _kill(self, wire: _Wire | None) -> None:
        """End the process, gracefully if it is already shutting down."""
        if self._heartbeat is not None:
            self._heartbeat.end()
            self._heartbeat = None
        if wire is not None:
            wire.close()
        if self._process is not None and self._process.poll() is None:
            try:
                self._process.wait(timeout=0.2)
            except subprocess.TimeoutExpired:
                self._process.kill()
                self._process.wait()

    def _how_it_ended(self) -> str:
        return describe_exit(self._process, what=_WHAT)

    def _opened(self) -> tuple[SnapshotLayout, SharedNumbers]:
        if self._layout is None or self._state is None:
            raise _not_open()
        return self._layout, self._state


class _Wire(asyncio.Protocol):
    """The parent's end of the socket."""

    def __init__(self, listener: WorldListener, how_it_ended: Callable[[], str]) -> None:
        loop = asyncio.get_running_loop()
        self._listener = listener
        self._how_it_ended = how_it_ended
        self._reader = FrameReader()
        self._decode = msgspec.msgpack.Decoder(AnyReport).decode
        self._transport: asyncio.Transport | None = None
        self.first: asyncio.Future[WorldReady | WorldRefused] = loop.create_future()
        self.gone: asyncio.Future[None] = loop.create_future()
        self.lost_reason = ""
        self.closing = False
        self._restores: deque[asyncio.Future[None]] = deque()

    def connection_made(self, transport: asyncio.BaseTransport) -> None:
        assert isinstance(transport, asyncio.Transport)
        self._transport = transport

    def data_received(self, data: bytes) -> None:
        for message in self._reader.feed(data):
            report = self._decode(message)
            match report:
                case WorldReady() | WorldRefused():
                    self.first.set_result(report)
                case WorldRestored():
                    self._restored_first_in_line()
                case _:
                    self._listener.happened(report)

    def next_restored(self) -> asyncio.Future[None]:
        """Return a future that completes with the world's next restore."""
        future: asyncio.Future[None] = asyncio.get_running_loop().create_future()
        self._restores.append(future)
        return future

    def _restored_first_in_line(self) -> None:
        future = self._restores.popleft()
        if not future.done():
            future.set_result(None)

    def connection_lost(self, exc: Exception | None) -> None:
        if not self.gone.done():
            self.gone.set_result(None)
        if not self.lost_reason:
            self.lose(self._how_it_ended() if not self.closing else "")

    def lose(self, reason: str) -> None:
        """Fail all waiters because the world is lost; a deliberate close has its own reason."""
        reason = "the world was closed" if self.closing else reason
        self.lost_reason = reason
        if not self.first.done():
            self.first.set_exception(RobotError(f"{reason} before it was ready"))
        for future in self._restores:
            if not future.done():
                future.set_exception(RobotError(reason, hint=CONNECT_AGAIN))
        self._listener.lost(reason)

    def send(self, payload: bytes) -> None:
        assert self._transport is not None
        self._transport.write(frame_message(payload))

    def close(self) -> None:
        if self._transport is not None:
            self._transport.close()


def _not_open() -> RobotError:
    return RobotError("the simulated world is not open", hint="enter it with `async with` first")
