"""Equipment as a device of the cell: connects and reads, and sets outputs only once a person has enabled it."""

from __future__ import annotations

import asyncio
import logging
from collections.abc import Callable
from types import TracebackType
from typing import Self

from msgspec.structs import replace

from engine.bus import SkillBus
from engine.cell.drivers import DeviceReport, RoundTrip
from engine.document.equipment import EquipmentDocument
from engine.errors import RobotError
from engine.messages.device_state import DeviceState
from engine.robot import DeviceStatus
from robots.drivers.device_enabling import advertise_enabling, log_enabling
from robots.drivers.device_history import DeviceHistory
from robots.drivers.equipment.backends.pin_values import PinValue
from robots.drivers.equipment.device.equipment_signals import EquipmentOutputs, EquipmentSignals, PinSignals
from robots.drivers.equipment.device.equipment_transport import EquipmentCommand, EquipmentReading, EquipmentTransport
from robots.drivers.fresh_link import FreshLink, FreshReading, LinkTiming
from robots.io.wire.link_error import LinkError

_TIMING = LinkTiming(period_s=0.02, stale_s=0.5, silence_s=0.2)
_READ_BACK_S = 1.0
_REPORT_LIMIT_S = 20.0
_STOPPED = "STOP came before it was set"
_ENABLE_HINT = "look at the equipment, then permit it: `flexcell run --enable REASON`, or the skill enable_device"
_log = logging.getLogger("flexcell.devices")


class EquipmentDevice:
    """Implements `engine.cell.drivers.DrivenDevice`. Control is held from `enable` until it is lost or the cell closes.

    While it is held, an event loop that is silent for 0.2 s lets it go, and the server makes outputs safe.

    Args:
        name: Its bus namespace.
        transport: The wire.
        pins: The document that the server should have; None if the cell does not say.
        about: What a report says of the driver.
    """

    def __init__(
        self, name: str, transport: EquipmentTransport, *, pins: EquipmentDocument | None, about: DeviceReport
    ) -> None:
        self._name = name
        self._transport = transport
        self._pins = pins
        self._about = about
        self._link: FreshLink[EquipmentReading, EquipmentCommand] | None = None
        self._bus: SkillBus | None = None
        self._signals = EquipmentSignals(name, self._now, self._put)
        self._lost_reason = ""
        self._problem = "not enabled"
        self._changed: Callable[[], None] = lambda: None
        self._pending: dict[EquipmentCommand, asyncio.Future[float]] = {}
        self._waiters: list[tuple[Callable[[FreshReading[EquipmentReading]], bool], asyncio.Future[None]]] = []
        self._history = DeviceHistory()

    @property
    def name(self) -> str:
        """The bus namespace of its skills."""
        return self._name

    @property
    def lost_reason(self) -> str:
        """Why the connection is lost; empty while it is connected."""
        return self._lost_reason

    @property
    def outputs(self) -> EquipmentOutputs | None:
        """Its digital outputs, for tools at them; None while it is not connected."""
        return EquipmentOutputs(self._now, self._put) if self._link is not None and not self._lost_reason else None

    @property
    def status(self) -> DeviceStatus:
        """FAULT while its outputs may not be set."""
        if self._link is None:
            return DeviceStatus.DISCONNECTED
        return DeviceStatus.FAULT if self._blocked() else DeviceStatus.READY

    @property
    def controller(self) -> str:
        """Who controls the outputs, as the last reading says; empty for nobody."""
        latest = self._opened().latest
        return latest.value.pins.controller if latest is not None else ""

    def when_connection_changes(self, callback: Callable[[], None]) -> None:
        """Call `callback`, on the event loop, when the connection is lost and when it is restored."""
        self._changed = callback

    def register(self, bus: SkillBus) -> None:
        """Publish pins and `<name>/device`; advertise `SetOutput`, `SetDutyCycle` and `EnableDevice`."""
        self._bus = bus
        self._signals.register(bus)
        advertise_enabling(bus, self._name, self)
        self._publish_device()

    async def stop(self) -> None:
        """Tell the server STOP on a connection of its own; what waits to be set is not set any more.

        Raises:
            RobotError: the server could not be told, although it answers.
        """
        waiting = dict(self._pending)
        for command in waiting:
            command.revoked = _STOPPED
        await self._send_stop()
        if waiting:
            # One of them may have been on the wire already, and been executed after STOP.
            await asyncio.wait(waiting.values())
            await self._send_stop()

    async def reconnect(self) -> str:
        """Accept the connection that reads again; outputs need `EnableDevice` besides, and none is set.

        Raises:
            RobotError: the server does not answer yet.
        """
        if not self._lost_reason:
            return ""
        self._opened().fresh()
        self._lost_reason = ""
        self._signals.publish_changes()
        self._publish_device()
        self._changed()
        return f"{self._name} reads again; outputs are set only after {self._name}/enable_device"

    async def report(self, *, readings: int) -> DeviceReport:
        """Read the server this many times and return what it says."""
        times_s: list[float] = []

        def collected(reading: FreshReading[EquipmentReading]) -> bool:
            times_s.append(reading.took_s)
            return len(times_s) >= readings

        await self._until(collected, limit_s=_REPORT_LIMIT_S)
        pins = self._opened().fresh().pins
        control = f"controlled by {pins.controller}" if pins.controller else "nobody controls it"
        return replace(
            self._about,
            state=f"{pins.equipment}, {control}",
            fault=pins.problem or self._misfit(),
            readings={name: float(value) for name, value in pins.values.items()},
            round_trip=RoundTrip.of(times_s[:readings]),
        )

    async def __aenter__(self) -> Self:
        self._link = link = FreshLink(self._transport, self, _TIMING)
        try:
            await link.start()
        except BaseException as error:
            self._link = None
            if not isinstance(error, RobotError):
                raise
            what = f"equipment does not answer: {error.statement}"
            raise RobotError(what, where=self._name, hint=error.hint) from error
        return self

    async def __aexit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        link, self._link = self._opened(), None
        await link.close()

    def read(self, reading: FreshReading[EquipmentReading]) -> None:
        """Publish what has changed, and note that control was lost."""
        if not self._problem and not reading.value.controls:
            self._disable(reading.value.uncontrolled or "control was lost")
        self._signals.publish_changes()
        for condition, waiter in self._waiters:
            if not waiter.done() and condition(reading):
                waiter.set_result(None)
        self._waiters = [entry for entry in self._waiters if not entry[1].done()]

    def lost(self, reason: str) -> None:
        """Nothing is known of the pins any more; the server makes outputs safe by itself."""
        self._lost_reason = f"{self._name} at {self._transport.address}: {reason}"
        for _, waiter in self._waiters:
            if not waiter.done():
                waiter.set_exception(RobotError(self._lost_reason, where=self._name, hint=self._transport.remedy))
        self._waiters = []
        self._disable("the connection was lost, and setting outputs was not permitted since")
        self._signals.publish_changes()
        self._changed()

    def found(self) -> None:
        """Note that readings are back, and nothing else."""
        _log.warning("%s reads again; %s", self._name, self._problem)
        self._publish_device()

    def stopped_by_silence(self, silent_s: float) -> None:
        """Note that control was let go, as nobody could have noticed a STOP."""
        self._disable(f"the engine was silent for {silent_s:.2f} s; outputs are at their safe values")

    async def enable(self, reason: str, *, by: str = "") -> None:
        """Take control of the outputs; sets none.

        Raises:
            RobotError: it does not answer, its connection was not accepted by `reconnect`, another client controls, or
                the server has other pins than the document of the cell says.
        """
        link = self._opened()
        if self._lost_reason:
            raise RobotError(self._lost_reason, where=self._name, hint="first: flexcell cell connect")
        link.fresh()
        misfit = self._misfit()
        if misfit:
            hint = f"give the cell what the server has: flexcell equipment show --connect {self._transport.address}"
            raise RobotError(misfit, where=self._name, hint=hint)
        if not self._problem:
            return
        log_enabling(self._name, by=by, reason=reason)
        # Before: control must not be held by an event loop that hangs.
        link.arm(EquipmentCommand(action="let_go"))
        command = EquipmentCommand(action="control")
        try:
            taken_s = await link.submit(command)
            command.require_done()
            await self._until(lambda reading: reading.asked_s >= taken_s, limit_s=_READ_BACK_S)
            if not link.fresh().controls:
                raise RobotError(link.fresh().uncontrolled or "control was lost meanwhile", where=self._name)
        except BaseException:
            command.revoked = "it was not waited for"
            link.arm(None)
            if not isinstance(command.refusal, RobotError) and not link.lost_reason:
                # Nobody may set anything with a control that nobody knows of. A lost connection has none.
                letting = link.submit(EquipmentCommand(action="let_go"))
                letting.add_done_callback(lambda done: done.cancelled() or done.exception())
            raise
        self._problem = ""
        self._history.enabled(by=by, reason=reason)
        self._publish_device()

    def device_state(self) -> DeviceState:
        """Return whether the server answers and outputs may be set."""
        link, problem = self._opened(), self._blocked()
        state = DeviceState(
            driver=self._about.driver,
            address=self._transport.address,
            connected=not link.lost_reason,
            enabled=not problem,
            problem=problem,
        )
        return self._history.complete(state)

    def _now(self) -> PinSignals:
        if self._lost_reason:
            return PinSignals.unknown(self._lost_reason)
        try:
            pins = self._opened().fresh().pins
        except RobotError as error:
            return PinSignals.unknown(f"{self._name} at {error.statement}")
        if pins.problem or not pins.values:
            return PinSignals.unknown(f"{self._name}: {pins.problem or 'the server has no values'}")
        kinds = pins.kinds
        return PinSignals.of(
            pins.values,
            inputs=[name for name in pins.values if kinds.get(name) == "digital_input"],
            outputs=[name for name in pins.values if kinds.get(name) == "digital_output"],
            pwm=[name for name in pins.values if kinds.get(name) == "pwm"],
        )

    def _misfit(self) -> str:
        """Return how the pins of the server differ from the document of the cell; empty if they do not."""
        if self._pins is None:
            return ""
        due = {name: str(pin.__struct_config__.tag) for name, pin in self._pins.pins.items()}
        kinds = self._opened().fresh().pins.kinds
        wrong = [*(name for name in due if due[name] != kinds.get(name)), *(name for name in kinds if name not in due)]
        return f"the server has other pins than the document of the cell: {', '.join(wrong)}" if wrong else ""

    async def _put(self, output: str, value: PinValue) -> None:
        """Set an output and return when it is read back; raises RobotError."""
        problem = self._blocked()
        if problem:
            raise RobotError(problem, where=self._name, hint=_ENABLE_HINT)
        link = self._opened()
        command = EquipmentCommand(action="set", values={output: value})
        self._pending[command] = written = link.submit(command)

        def end(done: asyncio.Future[float]) -> None:
            del self._pending[command]
            done.exception()

        written.add_done_callback(end)
        try:
            # Not cancelled with what waits for it: STOP has to know when it is off the wire.
            set_s = await asyncio.shield(written)
            command.require_done()
            await self._until(lambda reading: reading.asked_s >= set_s, limit_s=_READ_BACK_S)
        finally:
            command.revoked = command.revoked or "it was not waited for"

    async def _send_stop(self) -> None:
        try:
            await asyncio.to_thread(self._transport.send_stop)
        except (LinkError, RobotError) as error:
            if self._lost_reason or self._link is None or self._link.lost_reason:
                return  # the server has made outputs safe when it lost this client; the loss is told already
            hint = f"outputs are safe once the server is silent; {self._transport.remedy}"
            raise RobotError(f"the server was not told STOP: {error}", where=self._name, hint=hint) from error

    def _opened(self) -> FreshLink[EquipmentReading, EquipmentCommand]:
        if self._link is None:
            raise RobotError("equipment is not connected", where=self._name)
        return self._link

    def _blocked(self) -> str:
        return self._lost_reason or self._problem

    def _disable(self, problem: str) -> None:
        if self._link is not None:
            self._link.arm(None)
        if problem != self._problem:
            _log.error("outputs of %s may not be set: %s", self._name, problem)
            self._problem = problem
            self._publish_device()

    async def _until(self, condition: Callable[[FreshReading[EquipmentReading]], bool], *, limit_s: float) -> None:
        """Wait for a reading that meets a condition."""
        waiter: asyncio.Future[None] = asyncio.get_running_loop().create_future()
        self._waiters.append((condition, waiter))
        try:
            async with asyncio.timeout(limit_s):
                await waiter
        except TimeoutError:
            raise RobotError(
                f"the server was not read within {limit_s:g} s", where=self._name, hint=self._transport.remedy
            ) from None
        finally:
            waiter.cancel()

    def _publish_device(self) -> None:
        if self._bus is not None and self._link is not None:
            self._bus.topic(f"{self._name}/device", DeviceState).publish(self.device_state())
