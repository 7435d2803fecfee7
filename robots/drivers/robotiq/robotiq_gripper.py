"""A real Robotiq gripper: what activates it, and what its status says of faults and of other clients."""

from __future__ import annotations

from msgspec.structs import replace

from engine.bus import SkillBus
from engine.cell.drivers import DeviceReport, RoundTrip
from engine.messages import GripperState
from robots.drivers.device_transport import DeviceTransport
from robots.drivers.fresh_link import FreshLink, FreshReading, LinkTiming
from robots.drivers.robotiq.gripper_registers import ACTIVATE, RESET, GripperCommand, GripperStatus
from robots.drivers.robotiq.gripper_units import WidthTable, width_of_count
from robots.drivers.robotiq.robotiq_motion import ECHO_LIMIT_S
from robots.drivers.robotiq.robotiq_port import PATIENCE_S, RobotiqPort
from robots.drivers.tool_device import DisableCause, ToolDevice
from robots.gripper import GripperServer

ACTIVATION_LIMIT_S = 10.0

RobotiqLink = FreshLink[GripperStatus, GripperCommand]


class RobotiqGripper(ToolDevice[GripperStatus, GripperCommand, RobotiqPort]):
    """The device of a gripper with measured counts and openings, `widths`."""

    def __init__(
        self,
        name: str,
        transport: DeviceTransport[GripperStatus, GripperCommand],
        *,
        timing: LinkTiming,
        widths: WidthTable,
        about: DeviceReport,
        patience_s: float = PATIENCE_S,
    ) -> None:
        super().__init__(name, transport, timing=timing, about=about, words="the gripper")
        self._widths = widths
        self._patience_s = patience_s
        self._server: GripperServer | None = None

    def _new_port(self, link: RobotiqLink) -> RobotiqPort:
        return RobotiqPort(self.name, link, widths=self._widths, blocked=self._blocked, patience_s=self._patience_s)

    def _new_server(self, port: RobotiqPort) -> GripperServer:
        self._server = GripperServer(name=self.name, port=port)
        return self._server

    def _follow(self, port: RobotiqPort, reading: FreshReading[GripperStatus]) -> None:
        port.take(reading)

    def _disable_cause(self, reading: FreshReading[GripperStatus]) -> DisableCause | None:
        status, command = reading.value, self.port.command
        if status.fault_name:
            self.port.withdraw()
            return DisableCause(problem=f"fault of the gripper: {status.fault_name}", at_rest=True)
        if not status.active:
            return DisableCause(problem="the gripper is not activated, as after it was switched on", at_rest=True)
        if command is not None and not self._problem and self._is_foreign(status, reading.asked_s):
            echo = f"position request {status.position_echo}, ours was {command.position}"
            return DisableCause(
                problem=f"another client commands the gripper: {echo}, go is {status.go}", at_rest=False
            )
        return None

    def _is_foreign(self, status: GripperStatus, asked_s: float) -> bool:
        """Return whether the gripper echoes a command that we did not give, some time after the last of ours."""
        port = self.port
        command = port.command
        if command is None or asked_s - port.commanded_s < ECHO_LIMIT_S / 2.0:
            return False
        return status.position_echo != command.position or status.go != port.commanded_go

    async def _activate(self, link: RobotiqLink) -> None:
        """Activate the gripper where needed, which moves its fingers."""
        status = link.fresh()
        if status.active and not status.needs_reset:
            return
        await link.submit(RESET)
        await self._until(lambda now: not now.activated, limit_s=ACTIVATION_LIMIT_S)
        await link.submit(ACTIVATE)
        await self._until(lambda now: now.active or bool(now.fault_name), limit_s=ACTIVATION_LIMIT_S)

    def _activation_stop(self) -> GripperCommand:
        return RESET

    def _inactive(self, value: GripperStatus) -> str:
        return value.fault_name or ("" if value.active else "it did not become active")

    def _fault(self, value: GripperStatus) -> str:
        return value.fault_name

    def _reported(self, about: DeviceReport, value: GripperStatus, round_trip: RoundTrip) -> DeviceReport:
        measured = {
            "position_counts": float(value.position),
            "width_m": width_of_count(value.position, self._widths),
            "current_a": value.current_a,
        }
        return replace(about, state=_words(value), fault=value.fault_name, readings=measured, round_trip=round_trip)

    def _publish_state(self, bus: SkillBus) -> None:
        if self._server is not None:
            bus.topic(f"{self.name}/state", GripperState).publish(self._server.state())


def _words(status: GripperStatus) -> str:
    if not status.active:
        return f"not activated ({status.activation.name.lower()})"
    contact = status.contact.name.lower().replace("_", " ")
    return f"active, {contact}" if status.go else f"active, stopped, {contact}"
