"""Serves an emulated hand on one line, and its faults on the side channel, until it is cancelled."""

from __future__ import annotations

from collections.abc import Mapping

from engine.cell.drivers import Ready
from robots.drivers.emulation.byte_stream import PtyStream, TcpStream
from robots.drivers.emulation.plant import ALONE, Plant
from robots.drivers.emulation.serve_emulator import execute_wire_fault, number, serve_emulator
from robots.drivers.emulation.side_channel import Request
from robots.drivers.emulation.wire_faults import WireFaults
from robots.drivers.softhand.emulation.emulated_hand import CLOSED_TICKS, EmulatedHand
from robots.drivers.softhand.emulation.hand_session import HandSession, HandWire
from robots.drivers.softhand.emulation.kinematic_tendon import KinematicTendon
from robots.drivers.softhand.emulation.softhand_emulator import SoftHandEmulatorOptions


class HandFaults:
    """Executes the requests of the side channel: `do` names what, further keys its values.

    Faults of the wire as `execute_wire_fault`, besides checksum: each answer has a wrong one. object: `share`, null for
    nothing; stuck: whether the motor does not turn, `on`; `tendon` is None where a world has the fingers, and what is
    in the hand. current: `current_ma` of a defect. inactive: the motor is switched off. restart: power off and on.
    foreign: another client closes to `ticks`. state: the true state.
    """

    def __init__(
        self, wire: HandWire, tendon: KinematicTendon | None, stream: TcpStream | PtyStream, faults: WireFaults
    ) -> None:
        self._wire = wire
        self._tendon = tendon
        self._stream = stream
        self._faults = faults

    async def execute(self, request: Request) -> Mapping[str, object]:
        """Execute one request; raises KeyError, TypeError or ValueError for what is not one."""
        hand, what = self._wire.hand, str(request["do"])
        match what:
            case "checksum":
                self._wire.wrong_checksum = True
            case "object":
                share = None if request["share"] is None else number(request["share"])
                self._own_tendon().object_share = share
            case "current":
                hand.extra_ma = number(request["current_ma"])
            case "stuck":
                self._own_tendon().stuck = bool(request["on"])
            case "inactive":
                hand.switch(on=False)
            case "restart":
                hand.restart()
                await self._stream.close()
                await self._stream.open()
            case "foreign":
                hand.follow(int(number(request["ticks"])))
            case "state":
                return self._state()
            case _:
                await execute_wire_fault(request, self._faults, self._stream)
                self._wire.wrong_checksum = self._wire.wrong_checksum and what != "restore"
        return {"ok": True}

    def _own_tendon(self) -> KinematicTendon:
        """Return the tendon as it is now."""
        if self._tendon is None:
            raise ValueError("its fingers are in a world: put a part into the hand there")
        self._tendon.measured()
        return self._tendon

    def _state(self) -> Mapping[str, object]:
        hand, tendon = self._wire.hand, self._tendon
        return {
            "time_s": hand.now_s(),
            "position_ticks": hand.position_ticks,
            "reference_ticks": hand.reference_ticks,
            "current_ma": hand.current_ma,
            "active": hand.active,
            "moving": hand.moving,
            **({"travel": CLOSED_TICKS * tendon.travel} if tendon is not None else {}),
            "commands": hand.commands,
            "clients": self._stream.clients,
        }


async def serve_hand(options: SoftHandEmulatorOptions, ready: Ready, plant: Plant = ALONE) -> None:
    """Serve until this is cancelled; `ready` receives where. The fingers are those of the plant, if it has some."""
    faults = WireFaults()
    own = KinematicTendon(plant.clock.now_s)
    tendon = own if plant.tool is None else None
    own.object_share = options.object_share if options.object_share >= 0.0 else None
    hand = EmulatedHand(plant.clock.now_s, plant.tool or own, active=options.active)
    wire = HandWire(hand, unit=options.unit)
    stream = (
        PtyStream(lambda: HandSession(wire), faults)
        if options.connection == "serial"
        else TcpStream(lambda: HandSession(wire), faults, host=options.host, port=options.port)
    )
    execute = HandFaults(wire, tendon, stream, faults).execute
    await serve_emulator(
        stream, execute, ready, connection=options.connection, host=options.host, side_port=options.side_port
    )
