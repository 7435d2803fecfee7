"""STOP of a session: stops runs, goals and robots, and releases the devices when all have ended."""

from __future__ import annotations

import asyncio
from collections.abc import Generator, Mapping
from contextlib import contextmanager

from engine.cell.open_cell import OpenCell
from engine.errors import ControlError
from engine.project.session_run import SessionRun
from engine.stop import StopNotice

_PATIENCE_S = 5.0
"""How long a start waits for an earlier stop."""


class SessionStops:
    """Executes every stop of a session, whether it arrives through the event loop or through the relay.

    Args:
        cell: The cell; its relay, if it has one, latches the devices until the runs have ended.
        runs: The runs of the session by id, kept up to date by the session.
    """

    def __init__(self, cell: OpenCell, runs: Mapping[str, SessionRun]) -> None:
        self._cell = cell
        self._runs = runs
        self._active_stops: set[asyncio.Future[None]] = set()
        self._releases: set[asyncio.Task[None]] = set()

    def begin(self) -> None:
        """Subscribe to stops of the relay, which bypass the event loop."""
        if self._cell.relay is not None:
            self._cell.relay.on_stop(self._stopped_by_relay)

    def end(self) -> None:
        """Unsubscribe from stops of the relay."""
        if self._cell.relay is not None:
            self._cell.relay.on_stop(None)

    async def released(self) -> None:
        """Wait until the devices of every stop so far are released."""
        if self._releases:
            await asyncio.wait(self._releases)

    async def over(self) -> None:
        """Wait until every stop has ended: all runs and goals, and the latch of the devices.

        Raises:
            ControlError: a stop does not end in time.
        """
        try:
            async with asyncio.timeout(_PATIENCE_S):
                while pending := {*self._active_stops, *self._releases}:
                    await asyncio.wait(pending)
        except TimeoutError as error:
            raise ControlError(
                "a STOP is still in progress", hint="start again after the stopped runs have ended"
            ) from error

    async def stop_all(self, *, reason: str) -> None:
        """Stop everything and return when every robot is at rest; raises RobotError if one does not confirm it."""
        with self._carried_out():
            relay = self._cell.relay
            stop = await relay.order(reason) if relay is not None else None
            tasks = await self._stop_everything(reason)
            if stop is not None:
                release = asyncio.create_task(self._release(stop, tasks), name=f"release of stop {stop}")
                self._releases.add(release)
                release.add_done_callback(self._releases.discard)

    @contextmanager
    def _carried_out(self) -> Generator[None]:
        over: asyncio.Future[None] = asyncio.get_running_loop().create_future()
        self._active_stops.add(over)
        try:
            yield
        finally:
            self._active_stops.remove(over)
            over.set_result(None)

    async def _stop_everything(self, reason: str) -> tuple[asyncio.Task[None], ...]:
        """Stop runs, goals and robots; return the tasks of the runs, which may still be cleaning up."""
        active_runs = [started for started in self._runs.values() if started.result is None]
        for started in active_runs:
            started.stop(reason)
        await self._cell.stop()
        return tuple(started.task for started in active_runs if started.task is not None)

    async def _stopped_by_relay(self, notice: StopNotice) -> None:
        """End all runs and goals; the devices are already stopped, and are released when this returns."""
        with self._carried_out():
            tasks = await self._stop_everything(notice.reason)
            if tasks:
                await asyncio.wait(tasks)

    async def _release(self, stop: int, tasks: tuple[asyncio.Task[None], ...]) -> None:
        """Release the devices when no stopped run or goal can send them commands any more."""
        if tasks:
            await asyncio.wait(tasks)
        if self._cell.relay is not None:
            self._cell.relay.release(stop)
