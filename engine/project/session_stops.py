"""STOP of a session: stops runs, goals and robots, and stays latched until an operator releases it.

There are two latches. That of the devices (`engine.stop`) refuses every motion, and ends by itself when all stopped
runs have ended: from then on an operator may move arms by hand. That of the session refuses runs until it is released.
"""

from __future__ import annotations

import asyncio
import time
from collections.abc import Callable, Generator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass, field

from msgspec.structs import replace

from engine.cell.open_cell import OpenCell
from engine.errors import ControlError, FlexcellError
from engine.project.cell_stop import StoppedDevice, StoppedRun
from engine.project.session_run import SessionRun
from engine.runtime.history.resume import last_entered_state
from engine.stop import StopNotice

_PATIENCE_S = 5.0
"""How long a start waits for an earlier stop."""


@dataclass(kw_only=True)
class StopRecord:
    """What is known of the latest stop; `runs` are those that it has ended, without those that were continued."""

    number: int
    first: int
    """The number of the first stop since runs could start."""
    reason: str
    since_unix_s: float
    started_s: float
    devices: dict[str, StoppedDevice]
    runs: dict[str, StoppedRun] = field(default_factory=dict[str, StoppedRun])
    released: bool = False


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
        self._number = 0
        self._callbacks: tuple[Callable[[], None], ...] = ()
        self.latest: StopRecord | None = None
        """The latest stop, until it is forgotten."""

    @property
    def in_progress(self) -> bool:
        """Whether a stop has not ended yet: runs, goals, or the latch of the devices."""
        return bool(self._active_stops or self._releases)

    @property
    def latched(self) -> bool:
        """Whether the latest stop still has to be released."""
        return self.latest is not None and not self.latest.released

    def activity(self) -> str:
        """Return what is under way that closing the cell would end, a stop included; empty for nothing."""
        if self.latched:
            return "the cell is stopped"
        active = [f"run {run_id}" for run_id, started in self._runs.items() if started.result is None]
        ongoing = [*active, *(goal.address for goal in self._cell.bus.goals())]
        return f"{ongoing[0]} is active" if ongoing else ""

    def begin(self) -> None:
        """Subscribe to stops of the relay, which bypass the event loop."""
        if self._cell.relay is not None:
            self._cell.relay.on_stop(self._stopped_by_relay)

    def end(self) -> None:
        """Unsubscribe from stops of the relay."""
        if self._cell.relay is not None:
            self._cell.relay.on_stop(None)

    def when_changed(self, callback: Callable[[], None]) -> Callable[[], None]:
        """Call `callback` whenever something about the latest stop has changed; returns what unsubscribes."""
        self._callbacks = (*self._callbacks, callback)
        return lambda: self._unsubscribe(callback)

    def notify(self) -> None:
        """Report a change to all who follow the stops."""
        for callback in self._callbacks:
            callback()

    async def released(self) -> None:
        """Wait until the devices of every stop so far are released."""
        if self._releases:
            await asyncio.wait(self._releases)

    async def require_released(self) -> None:
        """Return once no stop is in progress and none is latched: runs may start.

        Raises:
            ControlError: the cell is stopped, or a stop does not end in time.
        """
        if self.latched:
            raise ControlError("the cell is stopped", hint="follow its recovery guide and release the stop")
        await self._over()

    async def release(self, number: int | None) -> None:
        """Let runs start again; waits until the stopped runs have ended. A stop that is released already stays so.

        Args:
            number: The stop that is meant; None for the latest.

        Raises:
            ControlError: the cell was stopped again, the stop is still in progress, or a device is not at rest.
        """
        record = self.latest
        if record is None:
            raise ControlError("the cell is not stopped", hint="runs can be started")
        if number not in (None, record.number):
            raise ControlError("the cell was stopped again", hint="look at the present stop first")
        await self._over()
        moving = [device for device in record.devices.values() if device.status != "at_rest"]
        if moving:
            raise ControlError(
                f"{moving[0].name} has not confirmed that it is at rest",
                hint="check it, connect the cell again if it is lost, then stop the cell once more",
            )
        record.released = True
        self.notify()

    def forget(self) -> None:
        """Forget the latest stop, unless it is latched."""
        if not self.latched:
            self.latest = None
            self.notify()

    def note_start(self, begin: str | None) -> None:
        """Note that a run was started, from run `begin` if given; when no stopped run is left, forget the stop."""
        record = self.latest
        if record is None:
            return
        record.runs = {run: stopped for run, stopped in record.runs.items() if begin is not None and run != begin}
        if not record.runs:
            self.forget()
        self.notify()

    async def stop_all(self, *, reason: str) -> None:
        """Stop everything and return when every robot is at rest; raises RobotError if one does not confirm it."""
        with self._carried_out():
            self._latch(reason)
            relay = self._cell.relay
            stop = await relay.order(reason) if relay is not None else None
            tasks = await self._stop_everything(reason)
            if stop is not None:
                release = asyncio.create_task(self._release(stop, tasks), name=f"release of stop {stop}")
                self._releases.add(release)
                release.add_done_callback(self._releases.discard)

    def _latch(self, reason: str) -> None:
        """Record a stop, unless it came on a second path of one that is in progress.

        The runs of an earlier stop that is not released stay known.
        """
        if self.latched and len(self._active_stops) > 1:
            return
        self._number += 1
        earlier = self.latest if self.latched else None
        self.latest = StopRecord(
            number=self._number,
            first=earlier.first if earlier is not None else self._number,
            reason=reason,
            since_unix_s=time.time(),
            started_s=asyncio.get_running_loop().time(),
            devices={each.name: StoppedDevice(name=each.name, status="stopping") for each in self._cell.devices},
            runs={**(earlier.runs if earlier is not None else {}), **self._active_runs()},
        )
        self.notify()

    def _active_runs(self) -> dict[str, StoppedRun]:
        """Return the runs that a stop ends now; the states that they had entered are looked for when all is at rest."""
        active = (started for started in self._runs.values() if started.result is None and not started.stopping)
        return {
            each.run.id: StoppedRun(id=each.run.id, behavior=each.behavior_id, seq=each.live.state.seq, path="")
            for each in active
        }

    def _find_states(self) -> None:
        record = self.latest
        if record is not None:
            record.runs = {
                run: stopped if stopped.path else replace(stopped, path=_last_state(self._runs.get(run), stopped.seq))
                for run, stopped in record.runs.items()
            }

    def _device_ended(self, name: str, failure: BaseException | None) -> None:
        record = self.latest
        if record is None or name not in record.devices or record.devices[name].status == "at_rest":
            return
        after_s = round(asyncio.get_running_loop().time() - record.started_s, 3)
        reason = "" if failure is None else _text(failure)
        status = "at_rest" if failure is None else "failed"
        record.devices[name] = StoppedDevice(name=name, status=status, after_s=after_s, reason=reason)
        self.notify()

    async def _over(self) -> None:
        """Wait until every stop has ended: all runs and goals, and the latch of the devices."""
        try:
            async with asyncio.timeout(_PATIENCE_S):
                while pending := {*self._active_stops, *self._releases}:
                    await asyncio.wait(pending)
        except TimeoutError as error:
            raise ControlError(
                "a STOP is still in progress", hint="try again after the stopped runs have ended"
            ) from error

    def _unsubscribe(self, callback: Callable[[], None]) -> None:
        self._callbacks = tuple(known for known in self._callbacks if known is not callback)

    @contextmanager
    def _carried_out(self) -> Generator[None]:
        over: asyncio.Future[None] = asyncio.get_running_loop().create_future()
        self._active_stops.add(over)
        try:
            yield
        finally:
            self._active_stops.remove(over)
            over.set_result(None)
            self._find_states()
            self.notify()

    async def _stop_everything(self, reason: str) -> tuple[asyncio.Task[None], ...]:
        """Stop runs, goals and robots; return the tasks of the runs, which may still be cleaning up."""
        active_runs = [started for started in self._runs.values() if started.result is None]
        for started in active_runs:
            started.stop(reason)
        await self._cell.stop(ended=self._device_ended)
        return tuple(started.task for started in active_runs if started.task is not None)

    async def _stopped_by_relay(self, notice: StopNotice) -> None:
        """End all runs and goals; the devices are already stopped, and are released when this returns."""
        with self._carried_out():
            if notice.source != "loss":
                # A lost relay is a lost device: runs are refused until the cell is connected again.
                self._latch(notice.reason)
            tasks = await self._stop_everything(notice.reason)
            if tasks:
                await asyncio.wait(tasks)

    async def _release(self, stop: int, tasks: tuple[asyncio.Task[None], ...]) -> None:
        """Release the devices when no stopped run or goal can send them commands any more."""
        if tasks:
            await asyncio.wait(tasks)
        if self._cell.relay is not None:
            self._cell.relay.release(stop)


def _last_state(started: SessionRun | None, seq: int) -> str:
    """Return the path of the state that a run had entered last up to its event `seq`; empty if it had entered none."""
    try:
        return last_entered_state(started.live.events, seq) if started is not None else ""
    except FlexcellError:
        # It has not entered a state yet.
        return ""


def _text(failure: BaseException) -> str:
    if isinstance(failure, FlexcellError):
        return f"{failure.message} ({failure.hint})" if failure.hint else failure.message
    return str(failure) or type(failure).__name__
