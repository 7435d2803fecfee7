"""A real Robotiq gripper as a device of the cell: connects and reads, moves only once a person has enabled it."""

from __future__ import annotations

import asyncio
import logging
from collections.abc import Callable
from types import TracebackType
from typing import Self

from msgspec.structs import replace

from engine.bus import SkillBus
from engine.cell.drivers import DeviceReport, RoundTrip
from engine.errors import GoalRejected, RobotError
from engine.messages import GripperState
from engine.messages.device_state import DeviceState
from engine.robot import DeviceStatus
from engine.skills.devices import EnableDevice
from robots.drivers.device_transport import DeviceTransport
from robots.drivers.fresh_link import FreshLink, FreshReading, LinkTiming
from robots.drivers.robotiq.gripper_registers import ACTIVATE, RESET, GripperCommand, GripperStatus
from robots.drivers.robotiq.gripper_units import WidthTable, width_of_count
from robots.drivers.robotiq.robotiq_motion import ECHO_LIMIT_S
from robots.drivers.robotiq.robotiq_port import RobotiqPort
from robots.gripper import GripperServer

ACTIVATION_LIMIT_S = 10.0
_STATE_PERIOD_S = 0.05
_REPORT_LIMIT_S = 20.0
_log = logging.getLogger("flexcell.devices")

RobotiqLink = FreshLink[GripperStatus, GripperCommand]


class RobotiqGripper:
    """Implements `engine.cell.drivers.DrivenDevice`.

    Args:
        name: Its bus namespace, `<arm>/gripper`.
        transport: The wire.
        timing: The times of its readings.
        widths: Measured counts and openings.
        about: What a report says of the driver.
    """

    def __init__(
        self,
        name: str,
        transport: DeviceTransport[GripperStatus, GripperCommand],
        *,
        timing: LinkTiming,
        widths: WidthTable,
        about: DeviceReport,
    ) -> None:
        self._name = name
        self._transport = transport
        self._timing = timing
        self._widths = widths
        self._about = about
        self._open: tuple[RobotiqLink, RobotiqPort, GripperServer] | None = None
        self._bus: SkillBus | None = None
        self._lost_reason = ""
        self._problem = "not connected"
        self._published_s = 0.0
        self._changed: Callable[[], None] = lambda: None
        self._enabling = False
        self._waiters: list[tuple[Callable[[GripperStatus], bool], asyncio.Future[None]]] = []
        self._collecting: list[float] | None = None

    @property
    def name(self) -> str:
        """The bus namespace of its skills."""
        return self._name

    @property
    def lost_reason(self) -> str:
        """Why the connection is lost; empty while it is connected."""
        return self._lost_reason

    @property
    def port(self) -> RobotiqPort:
        """The port of its skills; it is entered."""
        return self._opened()[1]

    @property
    def status(self) -> DeviceStatus:
        """FAULT while it may not move, CONNECTED while it is not enabled yet."""
        if self._open is None:
            return DeviceStatus.DISCONNECTED
        if self._problem or self._lost_reason:
            return DeviceStatus.FAULT
        return DeviceStatus.MOVING if self.port.motion is not None else DeviceStatus.READY

    def when_connection_changes(self, callback: Callable[[], None]) -> None:
        """Call `callback`, on the event loop, when the connection is lost and when it is restored."""
        self._changed = callback

    def register(self, bus: SkillBus) -> None:
        """Advertise the gripper skills and `EnableDevice`, publish `<name>/state` and `<name>/device`."""
        self._bus = bus
        server = self._opened()[2]
        server.register(bus)
        bus.advertise_service(EnableDevice, self._enable, namespace=self._name)
        self._publish_device()

    async def stop(self) -> None:
        """Stop the fingers where they are; a held object stays held.

        Raises:
            RobotError: rest could not be confirmed.
        """
        motion = self.port.motion
        if motion is not None:
            motion.cancel()
            report = await motion.report()
            if not report.at_rest:
                raise RobotError(report.reason, where=self._name, hint="use the emergency stop of the arm")

    async def reconnect(self) -> str:
        """Accept the connection that reads again; motion needs `EnableDevice` besides.

        Raises:
            RobotError: the gripper does not answer yet.
        """
        if not self._lost_reason:
            return ""
        self._opened()[0].fresh()
        self._lost_reason = ""
        self._publish_device()
        self._changed()
        return f"{self._name} reads again; it moves only after {self._name}/enable_device"

    async def report(self, *, readings: int) -> DeviceReport:
        """Read the gripper this many times and return what it says."""
        link = self._opened()[0]
        times_s: list[float] = []
        self._collecting = times_s
        await self._until(lambda _: len(times_s) >= readings, limit_s=_REPORT_LIMIT_S)
        self._collecting = None
        status = link.fresh()
        measured = {
            "position_counts": float(status.position),
            "width_m": width_of_count(status.position, self._widths),
            "current_a": status.current_a,
        }
        return replace(
            self._about,
            state=_words(status),
            fault=status.fault_name,
            readings=measured,
            round_trip=RoundTrip.of(times_s[:readings]),
        )

    async def __aenter__(self) -> Self:
        link: RobotiqLink = FreshLink(self._transport, self, self._timing)
        port = RobotiqPort(self._name, link, widths=self._widths, blocked=self._blocked)
        self._open = (link, port, GripperServer(name=self._name, port=port))
        self._problem = ""
        try:
            await link.start()
        except BaseException as error:
            # Also when it is cancelled while connecting: the thread must not outlive this call.
            await link.close()
            self._open = None
            if not isinstance(error, RobotError):
                raise
            raise RobotError(f"the gripper does not answer: {error}", where=self._name, hint=error.hint) from error
        return self

    async def __aexit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        link, port, _ = self._opened()
        try:
            if port.motion is not None and not self._lost_reason:
                await self.stop()
        finally:
            await link.close()
            self._open = None

    def read(self, reading: FreshReading[GripperStatus]) -> None:
        """Apply a reading: follow the motion, and note faults, lost activation and foreign commands."""
        _, port, _ = self._opened()
        if self._collecting is not None:
            self._collecting.append(reading.took_s)
        self._judge(reading)
        port.take(reading)
        for condition, waiter in self._waiters:
            if not waiter.done() and condition(reading.value):
                waiter.set_result(None)
        self._waiters = [entry for entry in self._waiters if not entry[1].done()]
        if reading.asked_s - self._published_s > _STATE_PERIOD_S:
            self._published_s = reading.asked_s
            self._publish_state()

    def lost(self, reason: str) -> None:
        """Fail the motion, whose end nobody sees; nothing moves again before a person permits it."""
        self._lost_reason = f"{self._name} at {self._transport.address}: {reason}"
        self._disable("the connection was lost, and motion was not permitted since", at_rest=False, cause=reason)
        self._changed()

    def found(self) -> None:
        """Note that readings are back, and nothing else."""
        _log.warning("%s reads again; %s", self._name, self._problem)
        self._publish_device()

    def stopped_by_silence(self, silent_s: float) -> None:
        """Note that the fingers were stopped because nobody could have noticed a STOP."""
        self.port.note_stop()
        self.port.fail(f"the engine was silent for {silent_s:.2f} s; the fingers were stopped", at_rest=True)

    def _opened(self) -> tuple[RobotiqLink, RobotiqPort, GripperServer]:
        if self._open is None:
            raise RobotError("the gripper is not connected", where=self._name)
        return self._open

    def _blocked(self) -> str:
        return self._lost_reason or self._problem

    def _judge(self, reading: FreshReading[GripperStatus]) -> None:
        """Find out whether the gripper may still move."""
        status, command = reading.value, self.port.command
        if self._enabling:
            return
        if status.fault_name:
            self.port.withdraw()
            self._disable(f"fault of the gripper: {status.fault_name}", at_rest=True)
        elif not status.active:
            self._disable("the gripper is not activated, as after it was switched on", at_rest=True)
        elif command is not None and not self._problem and self._is_foreign(status, reading.asked_s):
            echo = f"position request {status.position_echo}, ours was {command.position}"
            self._disable(f"another client commands the gripper: {echo}, go is {status.go}", at_rest=False)

    def _is_foreign(self, status: GripperStatus, asked_s: float) -> bool:
        """Return whether the gripper echoes a command that we did not give, some time after the last of ours."""
        port = self.port
        command = port.command
        if command is None or asked_s - port.commanded_s < ECHO_LIMIT_S / 2.0:
            return False
        return status.position_echo != command.position or status.go != port.commanded_go

    def _disable(self, problem: str, *, at_rest: bool, cause: str = "") -> None:
        if problem != self._problem:
            _log.error("%s may not move: %s", self._name, problem)
            self._problem = problem
            self._publish_device()
        self.port.fail(cause or problem, at_rest=at_rest)

    async def _enable(self, request: EnableDevice) -> DeviceState:
        bus = self._bus
        owner = bus.leases.owner(self._name) if bus is not None else None
        if owner is not None:
            raise GoalRejected(f"{self._name} is commanded by run {owner}", hint="end that run first")
        await self.enable(request.reason)
        return self.device_state()

    async def enable(self, reason: str) -> None:
        """Activate the gripper where needed, which moves its fingers, and permit motion.

        Raises:
            RobotError: it does not answer, its connection was not accepted by `reconnect`, or a fault remains.
        """
        link, port, _ = self._opened()
        if self._lost_reason:
            raise RobotError(self._lost_reason, where=self._name, hint="first: flexcell cell connect")
        status = link.fresh()
        _log.warning("%s is enabled: %s", self._name, reason)
        self._enabling = True
        try:
            if not status.active or status.needs_reset:
                await link.submit(RESET)
                await self._until(lambda now: not now.activated, limit_s=ACTIVATION_LIMIT_S)
                await link.submit(ACTIVATE)
                await self._until(lambda now: now.active or bool(now.fault_name), limit_s=ACTIVATION_LIMIT_S)
        finally:
            self._enabling = False
        status = link.fresh()
        if status.fault_name or not status.active:
            problem = status.fault_name or "it did not become active"
            raise RobotError(f"the gripper cannot be enabled: {problem}", where=self._name)
        port.forget()
        self._problem = ""
        self._publish_device()

    async def _until(self, condition: Callable[[GripperStatus], bool], *, limit_s: float) -> None:
        """Wait for a reading that meets a condition."""
        waiter: asyncio.Future[None] = asyncio.get_running_loop().create_future()
        self._waiters.append((condition, waiter))
        try:
            async with asyncio.timeout(limit_s):
                await waiter
        except TimeoutError:
            waiter.cancel()
            raise RobotError(
                f"the gripper did not get ready within {limit_s:g} s", where=self._name, hint=self._transport.remedy
            ) from None

    def device_state(self) -> DeviceState:
        """Return whether the gripper answers and may move."""
        link, latest = self._opened()[0], self._opened()[0].latest
        return DeviceState(
            driver=self._about.driver,
            address=self._transport.address,
            connected=not link.lost_reason,
            enabled=not self._blocked(),
            problem=self._blocked(),
            fault=latest.value.fault_name if latest is not None else "",
        )

    def _publish_device(self) -> None:
        if self._bus is not None and self._open is not None:
            self._bus.topic(f"{self._name}/device", DeviceState).publish(self.device_state())

    def _publish_state(self) -> None:
        if self._bus is not None and not self._lost_reason:
            self._bus.topic(f"{self._name}/state", GripperState).publish(self._opened()[2].state())


def _words(status: GripperStatus) -> str:
    if not status.active:
        return f"not activated ({status.activation.name.lower()})"
    contact = status.contact.name.lower().replace("_", " ")
    return f"active, {contact}" if status.go else f"active, stopped, {contact}"
