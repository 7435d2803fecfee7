"""A real arm as a device of the cell: connects and reads, moves only once a person has enabled it."""

from __future__ import annotations

import asyncio
import logging
from collections.abc import Callable, Mapping
from types import TracebackType
from typing import Self

from engine.bus import SkillBus, Topic
from engine.cell.drivers import DeviceReport
from engine.clock import Clock
from engine.errors import RobotError
from engine.messages import Pose
from engine.messages.device_state import DeviceLink, DeviceState
from engine.robot import DeviceStatus
from robots.arm.arm_server import ArmServer
from robots.drivers.arm.arm_connection import ArmConnection
from robots.drivers.arm.arm_setup import ArmSetup
from robots.drivers.arm.measured_topics import MeasuredTopics
from robots.drivers.device_enabling import advertise_enabling, log_enabling
from robots.drivers.device_history import DeviceHistory
from robots.drivers.link_meter import LinkMeter
from robots.port import ArmPort, SwitchableOutputs, Tolerance

_PUBLISH_PERIOD_S = 0.01
_log = logging.getLogger("flexcell.devices")


class DrivenArm:
    """Implements `engine.cell.drivers.DrivenDevice` and `robots.port.OutputOwner` on any connection to a real arm.

    Args:
        connection: Measures and commands it.
        setup: The arm in its cell.
        clock: Real time.
        about: What a report says of the driver.
        tolerance: How far the measured joints may be off the set point.
    """

    def __init__(
        self,
        connection: ArmConnection,
        *,
        setup: ArmSetup,
        clock: Clock,
        about: DeviceReport,
        tolerance: Tolerance | None = None,
    ) -> None:
        self._connection = connection
        self._setup = setup
        self._clock = clock
        self._about = about
        self._tolerance = tolerance
        self._name = setup.context.robot
        self._server: ArmServer | None = None
        self._bus: SkillBus | None = None
        self._topics: MeasuredTopics | None = None
        self._publishing: asyncio.Task[None] | None = None
        self._lost_reason = ""
        self._changed: Callable[[], None] = lambda: None
        self._published: DeviceState | None = None
        self._history = DeviceHistory()
        self._meter = LinkMeter()
        self._link: Topic[DeviceLink] | None = None

    @property
    def name(self) -> str:
        """The bus namespace of its skills and the resource that a run leases."""
        return self._name

    @property
    def port(self) -> ArmPort:
        """The port of its skills; it is entered."""
        return self._connection.port

    @property
    def outputs(self) -> SwitchableOutputs | None:
        """Its digital outputs; None without any, or while it is not entered."""
        return self._server.outputs if self._server is not None else None

    @property
    def status(self) -> DeviceStatus:
        """FAULT while it may not move."""
        if self._server is None:
            return DeviceStatus.DISCONNECTED
        return DeviceStatus.FAULT if self._problem else self._server.status

    @property
    def lost_reason(self) -> str:
        """Why the connection is lost; empty while it is connected, or once `reconnect` has accepted it again."""
        return self._lost_reason

    def when_connection_changes(self, callback: Callable[[], None]) -> None:
        """Call `callback`, on the event loop, when the connection is lost and when it is restored."""
        self._changed = callback

    def register(self, bus: SkillBus) -> None:
        """Advertise the motion skills and `EnableDevice`; publish joints, forces and `<name>/device`."""
        self._bus = bus
        self._opened().register(bus)
        advertise_enabling(bus, self._name, self)
        self._link = bus.topic(f"{self._name}/link", DeviceLink)
        self._link.provide(self._link_now)
        self._topics = MeasuredTopics(bus, self._name, self.port, self._setup.model)
        self._publishing = asyncio.get_running_loop().create_task(self._publish(), name=f"topics of {self._name}")
        self._publish_device()

    async def stop(self) -> None:
        """Bring the arm to rest; raises RobotError if rest could not be confirmed."""
        await self._opened().stop()

    async def reconnect(self) -> str:
        """Accept the connection that reads again; motion needs `EnableDevice` besides.

        Raises:
            RobotError: the controller does not answer yet.
        """
        if not self._lost_reason:
            return ""
        if self._connection.lost_reason:
            raise RobotError(self._connection.lost_reason, where=self._name, hint="check the controller and its cable")
        self._lost_reason = ""
        self._opened().world_restored()
        self._publish_device()
        self._changed()
        return f"{self._name} reads again; it moves only after {self._name}/enable_device"

    async def report(self, *, readings: int) -> DeviceReport:
        """Read the arm this many times and return what its controller says."""
        return await self._connection.report(readings=readings)

    async def __aenter__(self) -> Self:
        connection, setup = self._connection, self._setup
        connection.when_changed(self._on_change)
        try:
            await connection.open()
        except RobotError as error:
            what = f"the arm does not answer: {error.statement}"
            raise RobotError(what, where=self._name, hint=error.hint) from error
        try:
            outputs = connection.outputs
            self._server = ArmServer(
                name=self._name,
                model=setup.model,
                base=setup.placement.base,
                port=connection.port,
                clock=self._clock,
                outputs=setup.output_services(outputs) if outputs is not None else None,
                inputs=setup.input_services(connection.inputs),
                tolerance=self._tolerance,
                frames=self._frames(),
                workspace=setup.workspace(),
            )
            await self._server.__aenter__()
        except BaseException:
            # On any error, cancellation included, the connection must not stay open.
            await connection.close()
            self._server = None
            raise
        self._mirror()
        return self

    async def __aexit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        server, publishing = self._opened(), self._publishing
        try:
            if publishing is not None:
                publishing.cancel()
                await asyncio.wait((publishing,))
            await server.__aexit__(kind, error, trace)
        finally:
            await self._connection.close()
            self._server = self._publishing = None

    @property
    def _problem(self) -> str:
        return self._lost_reason or self._connection.lost_reason or self._connection.problem

    def _opened(self) -> ArmServer:
        if self._server is None:
            raise RobotError("the arm is not connected", where=self._name)
        return self._server

    def _on_change(self) -> None:
        """Note a loss, and publish what has changed."""
        lost_reason = self._connection.lost_reason
        if lost_reason and not self._lost_reason and self._server is not None:
            self._lost_reason = lost_reason
            self._server.world_lost(lost_reason)
            _log.error("%s", lost_reason)
            self._changed()
        self._publish_device()

    async def enable(self, reason: str, *, by: str = "") -> None:
        """Permit motion, with what a controller forgets set again.

        Raises:
            RobotError: it cannot move, or its connection was not accepted by `reconnect`.
        """
        if self._lost_reason:
            raise RobotError(self._lost_reason, where=self._name, hint="first: flexcell cell connect")
        log_enabling(self._name, by=by, reason=reason)
        await self._connection.enable()
        self._history.enabled(by=by, reason=reason)
        self._publish_device()

    def device_state(self) -> DeviceState:
        """Return whether the arm answers and may move."""
        problem, facts = self._problem, self._connection.facts()
        state = DeviceState(
            driver=self._about.driver,
            address=self._about.address,
            connected=not self._connection.lost_reason,
            enabled=not problem,
            problem=problem,
            firmware=facts.firmware,
            safety=facts.safety,
        )
        return self._history.complete(state)

    def _publish_device(self) -> None:
        if self._bus is None or self._server is None:
            return
        state = self.device_state()
        if state != self._published:
            self._published = state
            if state.problem:
                _log.warning("%s may not move: %s", self._name, state.problem)
            self._bus.topic(f"{self._name}/device", DeviceState).publish(state)

    async def _publish(self) -> None:
        while True:
            await asyncio.sleep(_PUBLISH_PERIOD_S)
            self._measure_link()
            inputs = self._opened().inputs
            if inputs is not None:
                inputs.publish_changes()
            if not self._connection.lost_reason:
                self._mirror()
                if self._topics is not None:
                    self._topics.publish()

    def _measure_link(self) -> None:
        """Publish how fresh the readings are, after each interval of the meter."""
        facts = self._connection.facts()
        now_s = asyncio.get_running_loop().time()
        has_ended = self._meter.note(now_s, readings=facts.readings, age_s=facts.age_s)
        if has_ended and self._link is not None and self._link.subscriber_count > 0:
            self._link.publish(self._link_now())

    def _link_now(self) -> DeviceLink:
        facts = self._connection.facts()
        return self._meter.link(age_s=facts.age_s, speed_scaling=facts.speed_scaling)

    def _frames(self) -> Mapping[str, Pose]:
        """Return the named frames of the cell; in a world they come and go with its modules."""
        world = self._setup.world
        return world.modules.frames if world is not None else self._setup.context.cell.document.fixed_frames

    def _mirror(self) -> None:
        """Place its body in the world where the arm is measured."""
        world = self._setup.world
        if world is not None:
            sample = self.port.sample()
            world.mirror(self._name, sample.position_rad, sample.velocity_rad_s)
