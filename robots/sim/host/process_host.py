"""A world in its own process, in real time: control keeps its deadlines while this process plans and serves."""

from __future__ import annotations

import asyncio
import os
import socket
from collections.abc import Callable
from functools import partial

from engine.errors import CONNECT_AGAIN, RobotError
from robots.control.motion_event import AnyMotionEvent, SetPointJumped
from robots.control.set_point_watch import report_jump
from robots.io.worker_process import WorkerProcess
from robots.port import Array
from robots.port.heartbeat import Heartbeat, new_heartbeat_file
from robots.port.loop_heartbeat import LoopHeartbeat
from robots.port.shared_file import new_shared_file
from robots.port.shared_numbers import SharedNumbers
from robots.scene.sim_scene import SimScene
from robots.sim.commands.world_commands import AnyCommand, ModulePlaced, PlaceModule, RestoreWorld, ShutDownWorld
from robots.sim.host.loop_timing import SIZE, LoopTiming, decode_timing
from robots.sim.host.world_host import WorldListener
from robots.sim.host.world_messages import BuildWorld, FromWorld, ToWorld, WorldReady
from robots.sim.loop.snapshot import CellSummary, SimSnapshot, SnapshotLayout

_START = "from robots.sim.host.process_main import main; main()"
_WHAT = "the world's process"
# On a loaded machine that compiles the controllers for the first time, one arm takes half a minute.
_END_S = 6.0
# A process that is already shutting down needs no more to exit.
_EXIT_S = 0.2
# On an overloaded machine this takes seconds; a timeout too early makes a run impossible to resume.
_ANSWER_S = 20.0


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
        self._worker: WorkerProcess[ToWorld, FromWorld] | None = None
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
        return self._worker.pid if self._worker is not None else 0

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

    def measures(self) -> dict[str, float]:
        """Return what the world has summed up until a fraction of a second ago."""
        return self.snapshot().measures()

    async def restore(self, image: Array) -> None:
        """Restore an image of this world; returns when the process has confirmed it."""
        await self._answer(RestoreWorld(image=image), what="restore its state")

    async def place_module(self, command: PlaceModule) -> ModulePlaced:
        """Plug or unplug a module between two steps of the process."""
        answer = await self._answer(command, what=f"place {command.module}")
        assert isinstance(answer, ModulePlaced)
        return answer

    async def _answer(self, request: ToWorld, *, what: str) -> FromWorld:
        answer = self._alive().ask(request).answer
        try:
            async with asyncio.timeout(_ANSWER_S):
                return await asyncio.shield(answer)
        except TimeoutError as error:
            raise RobotError(f"{_WHAT} did not {what} within {_ANSWER_S:g} s", hint=CONNECT_AGAIN) from error

    def send(self, command: AnyCommand) -> None:
        """Send a command; raises RobotError when the process is lost."""
        self._alive().send(command)

    async def open(self, listener: WorldListener) -> None:
        """Start the process and wait until its world is built; may be called again after a loss."""
        state_fd, timing_fd, heartbeat_fd = (
            new_shared_file("flexcell-state"),
            new_shared_file("flexcell-timing"),
            new_heartbeat_file(),
        )
        stop_line = self._new_stop_line("world") if self._new_stop_line is not None else None
        stop_fds = (stop_line.fileno(),) if stop_line is not None else ()
        worker = self._worker = WorkerProcess[ToWorld, FromWorld](
            _START,
            FromWorld,
            what=_WHAT,
            hint=CONNECT_AGAIN,
            on_notice=partial(_notify, listener),
            on_lost=listener.lost,
        )
        try:
            await worker.start(state_fd, timing_fd, heartbeat_fd, *stop_fds)
            ready = await self._built(worker)
            self._layout = SnapshotLayout(ready.summary)
            self._state = SharedNumbers(state_fd, self._layout.size + ready.summary.image_size)
            # Read once, so that a consistent state exists if the process dies in mid-write.
            self._state.read()
            self._timing = SharedNumbers(timing_fd, SIZE)
            self.fifo = ready.fifo
            self._begin_heartbeat(Heartbeat(heartbeat_fd))
        except BaseException:
            # On any error, cancellation included, no process may be left behind.
            self._worker = None
            self._end(worker)
            raise
        finally:
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
        if self._worker is not None:
            self._worker.kill(f"{_WHAT} has not stepped for {silent_s:.1f} s: it is frozen or starved, and was killed")

    async def _built(self, worker: WorkerProcess[ToWorld, FromWorld]) -> WorldReady:
        ready = worker.ask(BuildWorld(scene=self._scene)).answer
        limit_s = self._scene.start_limit_s
        try:
            async with asyncio.timeout(limit_s):
                answer = await asyncio.shield(ready)
        except TimeoutError as error:
            raise RobotError(
                f"{_WHAT} was started and had not built the world after {limit_s:g} s",
                hint="the machine may be overloaded: end other programs and start again, or allow more time in the"
                f" cell, `world: {{kind: mujoco, start_limit_s: {2 * limit_s:g}}}`",
            ) from error
        assert isinstance(answer, WorldReady)
        return answer

    async def close(self) -> None:
        """Bring everything to rest and end the process; kill it if it does not end."""
        worker, self._worker = self._worker, None
        if worker is None:
            return
        try:
            worker.end_reason = "the world was closed"
            if not worker.lost_reason:
                worker.send(ShutDownWorld())
                await worker.wait_closed(_END_S)
        finally:
            # Even if this is cancelled while it waits, no process may be left behind.
            self._end(worker)

    def _end(self, worker: WorkerProcess[ToWorld, FromWorld]) -> None:
        """End the process, gracefully if it is already shutting down."""
        if self._heartbeat is not None:
            self._heartbeat.end()
            self._heartbeat = None
        worker.end(grace_s=_EXIT_S)

    def _alive(self) -> WorkerProcess[ToWorld, FromWorld]:
        """Return the process for a message to it; raises RobotError when it is lost."""
        if self._worker is None:
            raise RobotError("the world's process was ended", hint=CONNECT_AGAIN)
        if self._heartbeat is not None and not self._worker.lost_reason:
            self._heartbeat.pulse()
        return self._worker

    def _opened(self) -> tuple[SnapshotLayout, SharedNumbers]:
        if self._layout is None or self._state is None:
            raise _not_open()
        return self._layout, self._state


def _not_open() -> RobotError:
    return RobotError("the simulated world is not open", hint="enter it with `async with` first")


def _notify(listener: WorldListener, message: FromWorld) -> None:
    if isinstance(message, SetPointJumped):
        report_jump(message)
    if isinstance(message, AnyMotionEvent):
        listener.happened(message)
