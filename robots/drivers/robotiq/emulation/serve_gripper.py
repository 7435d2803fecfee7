"""Serves an emulated gripper on one connection, and its faults on the side channel, until it is cancelled."""

from __future__ import annotations

from collections.abc import Mapping

from engine.cell.drivers import Ready
from robots.drivers.emulation.byte_stream import ProtocolSession, PtyStream, TcpStream
from robots.drivers.emulation.plant import ALONE, Plant
from robots.drivers.emulation.serve_emulator import execute_wire_fault, number, serve_emulator
from robots.drivers.emulation.side_channel import Request
from robots.drivers.emulation.wire_faults import WireFaults
from robots.drivers.robotiq.emulation.emulated_gripper import EmulatedGripper
from robots.drivers.robotiq.emulation.gripper_sessions import RegisterBank, RtuSession, TcpSession, UrcapSession
from robots.drivers.robotiq.emulation.kinematic_fingers import KinematicFingers
from robots.drivers.robotiq.emulation.robotiq_emulator import RobotiqEmulatorOptions
from robots.drivers.robotiq.gripper_registers import ACTIVATE, GripperCommand


class GripperFaults:
    """Executes the requests of the side channel: `do` names what, further keys its values.

    Faults of the wire as `execute_wire_fault`. object, ring: `width_m`, null for nothing; `fingers` are None where a
    world has the fingers, and what is between them. fault: `code`, 0 for none. restart: power off and on. foreign:
    another client moves to `position`, with `go`. state: the true state.
    """

    def __init__(
        self, bank: RegisterBank, fingers: KinematicFingers | None, stream: TcpStream | PtyStream, faults: WireFaults
    ) -> None:
        self._bank = bank
        self._fingers = fingers
        self._stream = stream
        self._faults = faults

    async def execute(self, request: Request) -> Mapping[str, object]:
        """Execute one request; raises KeyError, TypeError or ValueError for what is not one."""
        gripper = self._bank.gripper
        gripper.advance()
        match str(request["do"]):
            case "object":
                self._own_fingers().object_m = _width(request["width_m"])
            case "ring":
                self._own_fingers().ring_m = _width(request["width_m"])
            case "fault":
                gripper.fault = int(number(request["code"]))
            case "restart":
                gripper.restart()
                await self._stream.close()
                await self._stream.open()
            case "foreign":
                position, go = int(number(request["position"])), bool(request.get("go", True))
                self._bank.take(GripperCommand(activate=True, go=go, position=position, speed=255, force=0))
            case "state":
                return self._state()
            case _:
                await execute_wire_fault(request, self._faults, self._stream)
        return {"ok": True}

    def _own_fingers(self) -> KinematicFingers:
        if self._fingers is None:
            raise ValueError("its fingers are in a world: put a part between them there")
        return self._fingers

    def _state(self) -> Mapping[str, object]:
        gripper, fingers = self._bank.gripper, self._fingers
        status = gripper.status()
        return {
            "time_s": gripper.now_s(),
            "width_m": gripper.width_m,
            "position": status.position,
            "active": status.active,
            "go": status.go,
            "contact": status.contact.name,
            "fault": status.fault,
            **({"travel": fingers.travel, "rested_s": fingers.rested_s} if fingers is not None else {}),
            "commands": gripper.commands,
            "stopped_s": gripper.stopped_s,
            "clients": self._stream.clients,
        }


async def serve_gripper(options: RobotiqEmulatorOptions, ready: Ready, plant: Plant = ALONE) -> None:
    """Serve until this is cancelled; `ready` receives where. The fingers are those of the plant, if it has some."""
    faults = WireFaults()
    own = KinematicFingers(plant.clock.now_s)
    fingers = own if plant.tool is None else None
    activation_s = 0.0 if options.active else options.activation_s
    gripper = EmulatedGripper(plant.clock.now_s, plant.tool or own, activation_s=activation_s)
    if fingers is not None:
        fingers.object_m = options.object_m if options.object_m >= 0.0 else None
    bank = RegisterBank(gripper, unit=options.unit, at_zero=options.connection == "modbus_tcp", faults=faults)

    def new_session() -> ProtocolSession:
        match options.connection:
            case "modbus_tcp":
                return TcpSession(bank)
            case "urcap":
                return UrcapSession(bank)
            case "serial" | "rtu_over_tcp":
                return RtuSession(bank)

    if options.active:
        bank.take(ACTIVATE)
        gripper.advance()
        gripper.commands = 0
        if fingers is not None:
            fingers.travel = 0.0
    stream = (
        PtyStream(new_session, faults)
        if options.connection == "serial"
        else TcpStream(new_session, faults, host=options.host, port=options.port)
    )
    execute = GripperFaults(bank, fingers, stream, faults).execute
    await serve_emulator(
        stream, execute, ready, connection=options.connection, host=options.host, side_port=options.side_port
    )


def _width(value: object) -> float | None:
    return None if value is None else number(value)
