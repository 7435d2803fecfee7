"""A real tool as a device of the cell: connects and reads, moves only once a person has enabled it."""

from __future__ import annotations

import asyncio
import logging
import math
from abc import ABC, abstractmethod
from collections.abc import Callable
from dataclasses import dataclass
from types import TracebackType
from typing import Generic, Protocol, Self, TypeVar

from engine.bus import SkillBus
from engine.cell.drivers import DeviceReport, RoundTrip
from engine.errors import RobotError
from engine.messages.device_state import DeviceLink, DeviceState
from engine.robot import DeviceStatus
from robots.drivers.device_enabling import advertise_enabling, log_enabling
from robots.drivers.device_history import DeviceHistory
from robots.drivers.device_motion import DeviceMotion
from robots.drivers.device_transport import DeviceTransport
from robots.drivers.fresh_link import FreshLink, FreshReading, LinkTiming
from robots.drivers.link_meter import LinkMeter
from robots.gripper import ToolServer

_STATE_PERIOD_S = 0.05
_REPORT_LIMIT_S = 20.0
_log = logging.getLogger("flexcell.devices")


class LinkedToolPort(Protocol):
    """What the device of a tool needs of its port, beside what the skills need."""

    @property
    def motion(self) -> DeviceMotion | None:
        """The active motion."""
        ...

    def fail(self, reason: str, *, at_rest: bool) -> None:
        """End the active motion as failed."""
        ...

    def note_stop(self) -> None:
        """Note that the connection itself has stopped the tool."""
        ...

    def forget(self) -> None:
        """Forget the last command: the tool was enabled anew."""
        ...


@dataclass(frozen=True, kw_only=True)
class DisableCause:
    """Why a tool may not move any more, and whether it is known to be at rest."""

    problem: str
    at_rest: bool


R = TypeVar("R")
C = TypeVar("C")
P = TypeVar("P", bound=LinkedToolPort)


class ToolDevice(ABC, Generic[R, C, P]):
    """Implements `engine.cell.drivers.DrivenDevice`; a subclass knows readings and commands of one family.

    Args:
        name: Its bus namespace, `<arm>/<kind of tool>`.
        transport: The wire.
        timing: The times of its readings.
        about: What a report says of the driver.
        words: Its human-readable name, `the gripper`.
    """

    def __init__(
        self, name: str, transport: DeviceTransport[R, C], *, timing: LinkTiming, about: DeviceReport, words: str
    ) -> None:
        self._name = name
        self._transport = transport
        self._timing = timing
        self._about = about
        self._words = words
        self._open: tuple[FreshLink[R, C], P, ToolServer] | None = None
        self._bus: SkillBus | None = None
        self._lost_reason = ""
        self._problem = "not connected"
        self._published_s = 0.0
        self._changed: Callable[[], None] = lambda: None
        self._activation: asyncio.Task[None] | None = None
        self._activation_stopped = False
        self._losses = 0
        self._waiters: list[tuple[Callable[[R], bool], asyncio.Future[None]]] = []
        self._collecting: list[float] | None = None
        self._history = DeviceHistory()
        self._meter = LinkMeter()
        self._readings = 0

    @property
    def name(self) -> str:
        """The bus namespace of its skills."""
        return self._name

    @property
    def lost_reason(self) -> str:
        """Why the connection is lost; empty while it is connected."""
        return self._lost_reason

    @property
    def port(self) -> P:
        """The port of its skills; it is entered."""
        return self._opened()[1]

    @property
    def status(self) -> DeviceStatus:
        """FAULT while it may not move."""
        if self._open is None:
            return DeviceStatus.DISCONNECTED
        if self._problem or self._lost_reason:
            return DeviceStatus.FAULT
        return DeviceStatus.MOVING if self.port.motion is not None else DeviceStatus.READY

    def when_connection_changes(self, callback: Callable[[], None]) -> None:
        """Call `callback`, on the event loop, when the connection is lost and when it is restored."""
        self._changed = callback

    def register(self, bus: SkillBus) -> None:
        """Advertise the skills of the tool and `EnableDevice`, publish `<name>/state` and `<name>/device`."""
        self._bus = bus
        self._opened()[2].register(bus)
        advertise_enabling(bus, self._name, self)
        bus.topic(f"{self._name}/link", DeviceLink).provide(self._link_now)
        self._publish_device()

    async def stop(self) -> None:
        """Stop the tool where it is; a held object stays held. An activation ends, and the tool is not enabled.

        Raises:
            RobotError: rest could not be confirmed.
        """
        if self._activation is not None:
            self._activation_stopped = True
            self._activation.cancel()
            command = self._activation_stop()
            if command is not None:
                await self._opened()[0].submit(command)
        motion = self.port.motion
        if motion is not None:
            motion.cancel()
            report = await motion.report()
            if not report.at_rest:
                raise RobotError(report.reason, where=self._name, hint="use the emergency stop of the arm")

    async def reconnect(self) -> str:
        """Accept the connection that reads again; motion needs `EnableDevice` besides.

        Raises:
            RobotError: the tool does not answer yet.
        """
        if not self._lost_reason:
            return ""
        self._opened()[0].fresh()
        self._lost_reason = ""
        self._publish_device()
        self._changed()
        return f"{self._name} reads again; it moves only after {self._name}/enable_device"

    async def report(self, *, readings: int) -> DeviceReport:
        """Read the tool this many times and return what it says."""
        link = self._opened()[0]
        times_s: list[float] = []
        self._collecting = times_s
        await self._until(lambda _: len(times_s) >= readings, limit_s=_REPORT_LIMIT_S)
        self._collecting = None
        return self._reported(self._about, link.fresh(), RoundTrip.of(times_s[:readings]))

    async def __aenter__(self) -> Self:
        link: FreshLink[R, C] = FreshLink(self._transport, self, self._timing)
        port = self._new_port(link)
        self._open = (link, port, self._new_server(port))
        self._problem = ""
        try:
            await link.start()
        except BaseException as error:
            self._open = None
            if not isinstance(error, RobotError):
                raise
            what = f"{self._words} does not answer: {error.statement}"
            raise RobotError(what, where=self._name, hint=error.hint) from error
        return self

    async def __aexit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        link, port, _ = self._opened()
        try:
            if (port.motion is not None or self._activation is not None) and not self._lost_reason:
                await self.stop()
        finally:
            await link.close()
            self._open = None

    def read(self, reading: FreshReading[R]) -> None:
        """Apply a reading: follow the motion, and note faults, lost activation and foreign commands."""
        port = self.port
        self._measure_link(reading)
        if self._collecting is not None:
            self._collecting.append(reading.took_s)
        if self._activation is None:
            cause = self._disable_cause(reading)
            if cause is not None:
                self._disable(cause.problem, at_rest=cause.at_rest)
        self._follow(port, reading)
        for condition, waiter in self._waiters:
            if not waiter.done() and condition(reading.value):
                waiter.set_result(None)
        self._waiters = [entry for entry in self._waiters if not entry[1].done()]
        if reading.asked_s - self._published_s > _STATE_PERIOD_S:
            self._published_s = reading.asked_s
            if self._bus is not None and not self._lost_reason:
                self._publish_state(self._bus)

    def lost(self, reason: str) -> None:
        """Fail the motion, whose end nobody sees; nothing moves again before a person permits it."""
        self._lost_reason = f"{self._name} at {self._transport.address}: {reason}"
        self._losses += 1
        self._disable("the connection was lost, and motion was not permitted since", at_rest=False, cause=reason)
        self._changed()

    def found(self) -> None:
        """Note that readings are back, and nothing else."""
        _log.warning("%s reads again; %s", self._name, self._problem)
        self._publish_device()

    def stopped_by_silence(self, silent_s: float) -> None:
        """End the motion of a tool that was stopped because nobody could have noticed a STOP.

        It is stopped again: a callback that waited while the event loop was blocked may have moved it since.
        """
        self.port.note_stop()
        if self.port.motion is not None:
            self.port.motion.abort(f"the engine was silent for {silent_s:.2f} s; {self._words} was stopped")

    async def enable(self, reason: str, *, by: str = "") -> None:
        """Activate the tool where needed, which may move it, and permit motion.

        Raises:
            RobotError: it does not answer, its connection was not accepted by `reconnect`, a fault remains, it is
                being enabled already, or STOP came meanwhile.
        """
        link, port, _ = self._opened()
        if self._lost_reason:
            raise RobotError(self._lost_reason, where=self._name, hint="first: flexcell cell connect")
        if self._activation is not None:
            raise RobotError(f"{self._words} is being enabled already", where=self._name)
        link.fresh()
        log_enabling(self._name, by=by, reason=reason)
        losses, self._activation_stopped = self._losses, False
        self._activation = activation = asyncio.get_running_loop().create_task(self._activate(link))
        link.arm(self._activation_stop())
        try:
            await asyncio.wait((activation,))
        finally:
            command = self._activation_stop()
            if activation.cancel() and command is not None:
                # Nobody waits for it any more. A lost connection is reported by its loss.
                link.submit(command).add_done_callback(lambda stopped: stopped.cancelled() or stopped.exception())
            self._activation = None
            link.arm(None)
        if self._activation_stopped:
            raise RobotError(f"{self._words} was stopped while it was enabled", where=self._name)
        activation.result()
        # Also one that was accepted again meanwhile: nobody has permitted motion since.
        problem = self._inactive(link.fresh()) if self._losses == losses else "the connection was lost meanwhile"
        if problem:
            raise RobotError(f"{self._words} cannot be enabled: {problem}", where=self._name)
        port.forget()
        self._problem = ""
        self._history.enabled(by=by, reason=reason)
        self._publish_device()

    def device_state(self) -> DeviceState:
        """Return whether the tool answers and may move."""
        link, latest = self._opened()[0], self._opened()[0].latest
        state = DeviceState(
            driver=self._about.driver,
            address=self._transport.address,
            connected=not link.lost_reason,
            enabled=not self._blocked(),
            problem=self._blocked(),
            fault=self._fault(latest.value) if latest is not None else "",
            firmware=self._about.firmware,
        )
        return self._history.complete(state)

    @abstractmethod
    def _new_port(self, link: FreshLink[R, C]) -> P:
        """Return the port over a connection."""

    @abstractmethod
    def _new_server(self, port: P) -> ToolServer:
        """Return the server of the skills."""

    @abstractmethod
    def _follow(self, port: P, reading: FreshReading[R]) -> None:
        """Let the port take a reading."""

    @abstractmethod
    def _disable_cause(self, reading: FreshReading[R]) -> DisableCause | None:
        """Return why the tool may not move any more; None if nothing is wrong."""

    @abstractmethod
    async def _activate(self, link: FreshLink[R, C]) -> None:
        """Bring the tool to where it accepts motions, if it is not there."""

    @abstractmethod
    def _activation_stop(self) -> C | None:
        """Return the command that stops it while it is activated; None where nothing moves then."""

    @abstractmethod
    def _inactive(self, value: R) -> str:
        """Return why it does not accept motions; empty if it does."""

    @abstractmethod
    def _fault(self, value: R) -> str:
        """Return its fault by name; empty without one."""

    @abstractmethod
    def _reported(self, about: DeviceReport, value: R, round_trip: RoundTrip) -> DeviceReport:
        """Return a report with what the tool says."""

    @abstractmethod
    def _publish_state(self, bus: SkillBus) -> None:
        """Publish `<name>/state`."""

    def _opened(self) -> tuple[FreshLink[R, C], P, ToolServer]:
        if self._open is None:
            raise RobotError(f"{self._words} is not connected", where=self._name)
        return self._open

    def _blocked(self) -> str:
        return self._lost_reason or self._problem

    def _disable(self, problem: str, *, at_rest: bool, cause: str = "") -> None:
        if problem != self._problem:
            _log.error("%s may not move: %s", self._name, problem)
            self._problem = problem
            self._publish_device()
        self.port.fail(cause or problem, at_rest=at_rest)

    async def _until(self, condition: Callable[[R], bool], *, limit_s: float) -> None:
        """Wait for a reading that meets a condition."""
        waiter: asyncio.Future[None] = asyncio.get_running_loop().create_future()
        self._waiters.append((condition, waiter))
        try:
            async with asyncio.timeout(limit_s):
                await waiter
        except TimeoutError:
            waiter.cancel()
            raise RobotError(
                f"{self._words} did not get ready within {limit_s:g} s", where=self._name, hint=self._transport.remedy
            ) from None

    def _measure_link(self, reading: FreshReading[R]) -> None:
        """Publish how fresh the readings are, after each interval of the meter."""
        self._readings += 1
        age_s = max(reading.took_s, self._opened()[0].age_s())
        has_ended = self._meter.note(reading.asked_s, readings=self._readings, age_s=age_s)
        if has_ended and self._bus is not None:
            topic = self._bus.topic(f"{self._name}/link", DeviceLink)
            if topic.subscriber_count > 0:
                topic.publish(self._link_now())

    def _link_now(self) -> DeviceLink:
        age_s = self._open[0].age_s() if self._open is not None else math.inf
        return self._meter.link(age_s=age_s)

    def _publish_device(self) -> None:
        if self._bus is not None and self._open is not None:
            self._bus.topic(f"{self._name}/device", DeviceState).publish(self.device_state())
