"""A real SoftHand: what activates it, and what its readings say of faults and of other clients."""

from __future__ import annotations

from msgspec.structs import replace

from engine.bus import SkillBus
from engine.cell.drivers import DeviceReport, RoundTrip
from engine.messages import HandState
from robots.drivers.device_transport import DeviceTransport
from robots.drivers.fresh_link import FreshReading, LinkTiming
from robots.drivers.softhand.hand_reading import HandActivation, HandCommand, HandReading, HandReference
from robots.drivers.softhand.softhand_port import HandCalibration, HandLink, SoftHandPort
from robots.drivers.tool_device import DisableCause, ToolDevice
from robots.gripper import HandServer
from robots.port.hand_grasp_check import hand_state

_ACTIVATION_LIMIT_S = 5.0
# A motor that starts draws more for a moment.
_FAULT_READINGS = 3


class SoftHand(ToolDevice[HandReading, HandCommand, SoftHandPort]):
    """The device of a hand with one motor."""

    def __init__(
        self,
        name: str,
        transport: DeviceTransport[HandReading, HandCommand],
        *,
        timing: LinkTiming,
        calibration: HandCalibration,
        about: DeviceReport,
    ) -> None:
        super().__init__(name, transport, timing=timing, about=about, words="the hand")
        self._calibration = calibration
        self._over_current = 0

    def _new_port(self, link: HandLink) -> SoftHandPort:
        return SoftHandPort(self.name, link, calibration=self._calibration, blocked=self._blocked)

    def _new_server(self, port: SoftHandPort) -> HandServer:
        return HandServer(name=self.name, port=port)

    def _follow(self, port: SoftHandPort, reading: FreshReading[HandReading]) -> None:
        port.take(reading)

    def _disable_cause(self, reading: FreshReading[HandReading]) -> DisableCause | None:
        now = reading.value
        self._over_current = self._over_current + 1 if self._fault(now) else 0
        if self._over_current >= _FAULT_READINGS:
            if not self._problem:
                self.port.withdraw(now)
            return DisableCause(problem=f"fault of the hand: {self._fault(now)}", at_rest=True)
        if not now.active:
            return DisableCause(problem="the hand is not activated, as after it was switched on", at_rest=True)
        foreign = self.port.foreign_ticks(reading)
        if foreign is not None and not self._problem:
            problem = f"another client commands the hand, or a command was lost: it follows {foreign} ticks"
            return DisableCause(problem=problem, at_rest=False)
        return None

    async def _activate(self, link: HandLink) -> None:
        """Switch the motor on at the present position, so that it does not move."""
        if link.fresh().active:
            return
        await link.submit(HandReference(ticks=link.fresh().position_ticks))
        await link.submit(HandActivation(on=True))
        await self._until(lambda now: now.active, limit_s=_ACTIVATION_LIMIT_S)

    def _activation_stop(self) -> None:
        """Nothing: it is switched on where it is."""

    def _inactive(self, value: HandReading) -> str:
        return self._fault(value) or ("" if value.active else "its motor is not on")

    def _fault(self, value: HandReading) -> str:
        limit_ma = self._calibration.fault_ma
        if value.current_ma < limit_ma:
            return ""
        return f"over-current: the motor draws more than {limit_ma:.0f} mA; check that nothing blocks the tendon"

    def _reported(self, about: DeviceReport, value: HandReading, round_trip: RoundTrip) -> DeviceReport:
        measured = {
            "position_ticks": float(value.position_ticks),
            "reference_ticks": float(value.reference_ticks),
            "closed_share": self._calibration.share(value),
            "current_ma": float(value.current_ma),
            "pull_n": self._calibration.pull_n(value),
        }
        state = "active" if value.active else "not activated"
        return replace(about, state=state, fault=self._fault(value), readings=measured, round_trip=round_trip)

    def _publish_state(self, bus: SkillBus) -> None:
        port = self.port
        state = hand_state(port.sample(), max_force_n=port.max_force_n)
        bus.topic(f"{self.name}/state", HandState).publish(state)
