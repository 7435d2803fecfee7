"""The world's process: steps in real time, receives commands from a socket, writes its state to shared memory."""

from __future__ import annotations

import gc
import logging
import signal
import socket
import sys
import time
from types import FrameType

import numpy as np

from engine.errors import CellError
from engine.stop import StopLine
from robots.control.commanding.arm_commands import StopAll
from robots.io.message_socket import ClosedChannel, MessageSocket, PeerGone
from robots.io.process_log import log_nonblocking
from robots.io.real_time_schedule import take_real_time_schedule
from robots.io.request_failure import RequestFailure
from robots.port.control_process import EngineMonitor
from robots.port.heartbeat import Heartbeat
from robots.port.shared_numbers import SharedNumbers
from robots.port.stop_monitor import StopMonitor
from robots.sim.commands.world_commands import PlaceModule, RestoreWorld, ShutDownWorld
from robots.sim.host.loop_timing import SIZE, TimingCounter
from robots.sim.host.world_messages import BuildWorld, FromWorld, ToWorld, WorldReady, WorldRestored
from robots.sim.loop.simulation import Simulation
from robots.sim.physics.cell_model import build_cell

_SNAPSHOT_EVERY = 2
_TIMING_EVERY = 50
# A loop this far behind skips the lost time instead of catching up.
_LONGEST_LAG_S = 0.05
_SHUTDOWN_S = 4.0


class WorldLoop:
    """Steps a simulation in real time on the monotonic clock until it is asked to stop."""

    def __init__(
        self,
        simulation: Simulation,
        channel: MessageSocket[ToWorld, FromWorld],
        *,
        engine: EngineMonitor,
        stop: StopMonitor,
        state_fd: int,
        timing_fd: int,
    ) -> None:
        self._simulation = simulation
        self._channel: MessageSocket[ToWorld, FromWorld] | ClosedChannel[ToWorld, FromWorld] = channel
        self._engine = engine
        self._stop = stop
        # The measurement, followed by the image, so that both belong to one instant.
        self._values = np.zeros(simulation.layout.size + simulation.image_layout.size)
        self._image = self._values[simulation.layout.size :]
        self._shared = SharedNumbers(state_fd, len(self._values))
        self._shared_timing = SharedNumbers(timing_fd, SIZE)
        self._timing = TimingCounter()
        self._ending_at: float | None = None
        self.publish()

    def request_end(self, _signal: int = 0, _frame: FrameType | None = None) -> None:
        """Bring everything to rest, then end; also a signal handler."""
        if self._ending_at is None:
            self._ending_at = time.monotonic() + _SHUTDOWN_S

    def publish(self) -> None:
        """Write the present state to shared memory."""
        self._simulation.write_snapshot(self._values)
        self._simulation.write_image(self._image)
        self._shared.write(self._values)

    def run(self) -> None:
        """Step until the end is requested or the parent is gone or sends invalid data, and everything is at rest."""
        try:
            self._step_on()
        except PeerGone:
            self._come_to_rest()
        except Exception:
            # For any error: nothing else brings the devices of this process to rest.
            self._come_to_rest()
            raise
        finally:
            # The last heartbeat: since when everything is at rest.
            self._engine.look(time.monotonic())

    def _come_to_rest(self) -> None:
        self._channel = ClosedChannel()
        self._engine.engine_is_gone()
        self.request_end()
        self._step_on()

    def _step_on(self) -> None:
        step_s = self._simulation.step_s
        due = time.monotonic() + step_s
        while not self._over():
            wait = due - time.monotonic()
            if wait > 0.0:
                time.sleep(wait)
            late = time.monotonic() - due
            self._tick()
            due = self._next_due(due, step_s, late)

    def _over(self) -> bool:
        if self._ending_at is None:
            return False
        self._simulation.apply(StopAll())
        return self._simulation.at_rest or time.monotonic() > self._ending_at

    def _tick(self) -> None:
        for number, command in self._channel.receive():
            self._take(command, number)
        # Before the check of the engine's silence, so that motions report STOP as their cause.
        self._stop.look()
        if self._stop.cut:
            self.request_end()
        # After the commands: their sender has pulsed before.
        self._engine.look(time.monotonic())
        events = self._simulation.step()
        if events or self._simulation.steps % _SNAPSHOT_EVERY == 0:
            # The state is written before the event is sent, so a listener reads the state at the end.
            self.publish()
        for event in events:
            self._channel.post(event)
        self._channel.flush()
        if self._simulation.steps % _TIMING_EVERY == 0:
            self._shared_timing.write(self._timing.values)

    def _take(self, command: ToWorld, number: int) -> None:
        match command:
            case ShutDownWorld():
                self.request_end()
            case RestoreWorld():
                self._simulation.apply(command)
                self.publish()
                self._channel.post(WorldRestored(), number=number)
            case PlaceModule():
                placed = self._simulation.place_module(command)
                self.publish()
                self._channel.post(placed, number=number)
            case BuildWorld():
                raise CellError("the world is built once")
            case _:
                self._simulation.apply(command)

    def _next_due(self, due: float, step_s: float, late_s: float) -> float:
        now = time.monotonic()
        self._timing.count(late_s=late_s, overrun=now > due + step_s)
        if now - due > _LONGEST_LAG_S:
            self._timing.slip(now - due)
            return now + step_s
        return due + step_s


def main() -> None:
    """Run the world on the descriptors of socket, state, timing, heartbeat and, optionally, stop line."""
    connection_fd, state_fd, timing_fd, heartbeat_fd, *stop_fd = (int(argument) for argument in sys.argv[1:])
    # Ctrl-C reaches the whole process group; the parent brings the arms to rest first.
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    # The parent reports the jumps of set points: writing could block this loop.
    logging.getLogger("flexcell.set_points").disabled = True
    connection = socket.socket(fileno=connection_fd)
    channel = MessageSocket[ToWorld, FromWorld](connection, ToWorld)
    try:
        number, first = channel.wait()
        if not isinstance(first, BuildWorld):
            return
        scene = first.scene
        try:
            simulation = Simulation(build_cell(scene))
        except CellError as error:
            channel.send(RequestFailure.of(error), number=number)
            return
        connection.setblocking(False)
        engine = EngineMonitor(Heartbeat(heartbeat_fd), simulation, limit_s=scene.engine_silence_s, log=log_nonblocking)
        line = StopLine(socket.socket(fileno=stop_fd[0])) if stop_fd else None
        loop = WorldLoop(
            simulation,
            channel,
            engine=engine,
            stop=StopMonitor(line, simulation),
            state_fd=state_fd,
            timing_fd=timing_fd,
        )
        signal.signal(signal.SIGTERM, loop.request_end)
        fifo = take_real_time_schedule()
        gc.collect()
        gc.freeze()
        # A collection in mid-step would be late by milliseconds; the loop makes no cycles.
        gc.disable()
        channel.post(WorldReady(summary=simulation.summary, fifo=fifo), number=number)
        loop.run()
    except PeerGone:
        return
