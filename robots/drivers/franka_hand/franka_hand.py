"""A Franka Hand as a device: it moves once its stroke is known, which a person has it measure."""

from __future__ import annotations

from msgspec.structs import replace

from engine.bus import SkillBus
from engine.cell.drivers import DeviceReport, RoundTrip
from engine.errors import RobotError
from engine.messages import GripperState
from robots.drivers.device_transport import DeviceTransport
from robots.drivers.franka_hand.franka_hand_port import PATIENCE_S, FrankaHandLink, FrankaHandPort
from robots.drivers.franka_hand.franka_hand_reading import (
    FrankaHandCommand,
    FrankaHandReading,
    HomeFingers,
    StopFingers,
)
from robots.drivers.franka_hand.hand_protocol import HandReply
from robots.drivers.fresh_link import FreshReading, LinkTiming
from robots.drivers.tool_device import DisableCause, ToolDevice
from robots.gripper import GripperServer

HOMING_LIMIT_S = 30.0
_NOT_HOMED = "the hand is not homed, as after it was switched on"


class FrankaHand(ToolDevice[FrankaHandReading, FrankaHandCommand, FrankaHandPort]):
    """The device of a hand."""

    def __init__(
        self,
        name: str,
        transport: DeviceTransport[FrankaHandReading, FrankaHandCommand],
        *,
        timing: LinkTiming,
        patience_s: float = PATIENCE_S,
        about: DeviceReport,
    ) -> None:
        super().__init__(name, transport, timing=timing, about=about, words="the hand")
        self._patience_s = patience_s
        self._server: GripperServer | None = None

    def _new_port(self, link: FrankaHandLink) -> FrankaHandPort:
        return FrankaHandPort(self.name, link, blocked=self._blocked, patience_s=self._patience_s)

    def _new_server(self, port: FrankaHandPort) -> GripperServer:
        self._server = GripperServer(name=self.name, port=port)
        return self._server

    def _follow(self, port: FrankaHandPort, reading: FreshReading[FrankaHandReading]) -> None:
        port.take(reading)

    def _disable_cause(self, reading: FreshReading[FrankaHandReading]) -> DisableCause | None:
        return None if reading.value.is_homed else DisableCause(problem=_NOT_HOMED, at_rest=True)

    async def _activate(self, link: FrankaHandLink) -> None:
        """Home the hand where needed, which moves its fingers and drops what they hold."""
        if not link.fresh().is_homed:
            await self._home(link)

    async def _home(self, link: FrankaHandLink) -> None:
        """Return when the homing has ended, also without success; one that takes too long is stopped."""
        number = self.port.next_number()
        try:
            await link.submit(HomeFingers(number=number))
            # The stroke is known before the end, and comes on another socket than the end.
            await self._until(
                lambda now: now.ended == number and (now.is_homed or now.end_status != HandReply.SUCCESS),
                limit_s=HOMING_LIMIT_S,
            )
        except RobotError:
            # A lost connection is reported by its loss.
            link.submit(StopFingers()).add_done_callback(lambda stopped: stopped.cancelled() or stopped.exception())
            raise
        if link.fresh().end_status == HandReply.ABORTED:
            raise RobotError("the hand cannot be enabled: the hand has aborted its homing", where=self.name)

    def _activation_stop(self) -> FrankaHandCommand:
        return StopFingers()

    def _inactive(self, value: FrankaHandReading) -> str:
        return "" if value.is_homed else "the homing has measured no stroke"

    def _fault(self, value: FrankaHandReading) -> str:
        return ""

    def _reported(self, about: DeviceReport, value: FrankaHandReading, round_trip: RoundTrip) -> DeviceReport:
        state = value.state
        measured = {
            "width_m": state.width_m,
            "stroke_m": state.stroke_m,
            "temperature_c": float(state.temperature_c),
        }
        words = "not homed" if not value.is_homed else "grasping" if state.is_grasping else "homed"
        return replace(about, state=words, readings=measured, round_trip=round_trip)

    def _publish_state(self, bus: SkillBus) -> None:
        if self._server is not None:
            bus.topic(f"{self.name}/state", GripperState).publish(self._server.state())
