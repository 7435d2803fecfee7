"""A tool on digital outputs of another device, as a device of the cell: switched only once a person has enabled it."""

from __future__ import annotations

import asyncio
from collections.abc import Callable, Mapping
from contextlib import suppress
from types import TracebackType
from typing import Self

from msgspec.structs import replace

from engine.bus import SkillBus
from engine.cell.drivers import DeviceReport
from engine.errors import RobotError
from engine.messages.device_state import DeviceState
from engine.messages.topic_value import TopicValue
from engine.robot import DeviceStatus, Reconnectable, Robot
from engine.skills.digital_inputs import DigitalInputs
from robots.drivers.device_enabling import advertise_enabling, log_enabling
from robots.drivers.device_history import DeviceHistory
from robots.port import OutputOwner, SwitchableOutputs
from robots.sim.grip.tool_summary import ToolSummary
from robots.switched.switched_drive import SwitchedDrive, number_of
from robots.switched.switched_kind import SwitchedKind
from robots.switched.switched_options import SwitchedToolOptions

_STATE_PERIOD_S = 0.05
_NOT_ENABLED = "not enabled"


class SwitchedTool:
    """Implements `engine.cell.drivers.DrivenDevice`. It has no connection of its own: that of the other device counts.

    Args:
        name: Its bus namespace, `<arm>/<kind of tool>`.
        options: Outputs, times, sensor.
        kind: What serves a tool of its kind.
        tool: Range and force of its model.
        owner: Name of the device with the outputs.
        devices: The open devices of the cell.
        about: What a report says of the driver.
    """

    def __init__(
        self,
        name: str,
        options: SwitchedToolOptions,
        *,
        kind: SwitchedKind,
        tool: ToolSummary,
        owner: str,
        devices: Mapping[str, Robot],
        about: DeviceReport,
    ) -> None:
        self._name = name
        self._options = options
        self._owner = owner
        self._devices = devices
        self._about = about
        self._problem = _NOT_ENABLED
        self.drive = SwitchedDrive(
            name, options, tool=tool, outputs=self._outputs, detected=self._detected, blocked=self._blocked
        )
        self._server = kind.server(name, self.drive)
        self._bus: SkillBus | None = None
        self._publishing: asyncio.Task[None] | None = None
        self._published: DeviceState | None = None
        self._history = DeviceHistory()

    @property
    def name(self) -> str:
        """The bus namespace of its skills."""
        return self._name

    @property
    def lost_reason(self) -> str:
        """Always empty: the device with the outputs says it of both."""
        return ""

    @property
    def status(self) -> DeviceStatus:
        """FAULT while it may not be switched."""
        if self._publishing is None:
            return DeviceStatus.DISCONNECTED
        if self._blocked():
            return DeviceStatus.FAULT
        return DeviceStatus.MOVING if self.drive.motion is not None else DeviceStatus.READY

    def when_connection_changes(self, callback: Callable[[], None]) -> None:
        """Do nothing: it has no connection."""

    def register(self, bus: SkillBus) -> None:
        """Advertise the skills of the tool and `EnableDevice`, publish `<name>/state` and `<name>/device`."""
        self._bus = bus
        self._server.register(bus)
        advertise_enabling(bus, self._name, self)
        self._publishing = asyncio.get_running_loop().create_task(self._publish(bus), name=f"topics of {self._name}")

    async def stop(self) -> None:
        """Wait for the end of a switch; outputs keep their values, and a held object stays held."""
        await self._server.stop()
        if self.drive.motion is not None:
            await self.drive.motion.report()

    async def reconnect(self) -> str:
        """Do nothing: it has no connection."""
        return ""

    async def report(self, *, readings: int) -> DeviceReport:
        """Return what its outputs say, where they are open."""
        try:
            reading = self.drive.reading()
        except RobotError as error:
            return replace(self._about, state=f"not known: {error.message}")
        return replace(self._about, state="switched to hold" if reading.holds else "switched to release")

    async def __aenter__(self) -> Self:
        return self

    async def __aexit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        publishing, self._publishing = self._publishing, None
        if publishing is not None:
            publishing.cancel()
            await asyncio.wait((publishing,))
        await self.stop()

    async def enable(self, reason: str, *, by: str = "") -> None:
        """Permit switching.

        Raises:
            RobotError: the device with the outputs is not connected, or does not have them, or that of the sensor.
        """
        outputs, sensor = self._outputs(), self._options.sensor
        for output in self._options.outputs(holds=True):
            number_of(output, outputs, where=self._owner)
        if sensor is not None and sensor.input is not None and self._input(sensor.input) is None:
            hint = "`flexcell devices` lists the inputs that its driver reads"
            raise RobotError(f"{self._owner} has no input {sensor.input}", where=self._name, hint=hint)
        log_enabling(self._name, by=by, reason=reason)
        self._problem = ""
        self._history.enabled(by=by, reason=reason)
        self._publish_device()

    def device_state(self) -> DeviceState:
        """Return whether it may be switched."""
        lost, problem = self._loss(), self._blocked()
        state = DeviceState(
            driver=self._about.driver,
            address=self._about.address,
            connected=not lost,
            enabled=not problem,
            problem=problem,
        )
        return self._history.complete(state)

    def _outputs(self) -> SwitchableOutputs:
        owner = self._devices.get(self._owner)
        outputs = owner.outputs if isinstance(owner, OutputOwner) else None
        if outputs is None or self._loss():
            reason = self._loss() or f"{self._owner} has no digital outputs, or is not open yet"
            raise RobotError(reason, where=self._name, hint=f"look at the device {self._owner}")
        return outputs

    def _loss(self) -> str:
        owner = self._devices.get(self._owner)
        return owner.lost_reason if isinstance(owner, Reconnectable) else ""

    def _detected(self) -> bool | None:
        sensor, bus = self._options.sensor, self._bus
        if sensor is None or bus is None:
            return None
        if sensor.input is not None:
            value = self._input(sensor.input)
        else:
            latest = bus.topic(sensor.topic, TopicValue).latest
            value = latest.value if latest is not None else None
        return value != sensor.inverted if isinstance(value, bool) else None

    def _input(self, which: int | str) -> bool | None:
        """Return an input of the device with the outputs; None where nothing is known of it."""
        bus = self._bus
        latest = bus.topic(f"{self._owner}/digital_inputs", DigitalInputs).latest if bus is not None else None
        if latest is None:
            return None
        number = latest.names.get(which, -1) if isinstance(which, str) else which
        return latest.values[number] if 0 <= number < len(latest.values) else None

    def _blocked(self) -> str:
        return self._loss() or self._problem

    async def _publish(self, bus: SkillBus) -> None:
        while True:
            if self._loss() and not self._problem:
                self._problem = "the connection of its outputs was lost, and switching was not permitted since"
            self._publish_device()
            with suppress(RobotError):  # what is not known is not published; the problem of the device says why
                state = self._server.state()
                bus.topic(f"{self._name}/state", type(state)).publish(state)
            await asyncio.sleep(_STATE_PERIOD_S)

    def _publish_device(self) -> None:
        if self._bus is None:
            return
        state = self.device_state()
        if state != self._published:
            self._published = state
            self._bus.topic(f"{self._name}/device", DeviceState).publish(state)
