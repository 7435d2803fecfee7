"""Serves an emulated gripper on one connection, and its faults on the side channel, until it is cancelled."""

from __future__ import annotations

import asyncio
import time
from collections.abc import Mapping

from engine.cell.drivers import Ready
from robots.drivers.emulation.byte_stream import ProtocolSession, PtyStream, TcpStream
from robots.drivers.emulation.side_channel import Request, SideChannel
from robots.drivers.emulation.wire_faults import WireFaults
from robots.drivers.robotiq.emulation.emulated_gripper import EmulatedGripper
from robots.drivers.robotiq.emulation.gripper_sessions import RegisterBank, RtuSession, TcpSession, UrcapSession
from robots.drivers.robotiq.emulation.robotiq_emulator import RobotiqEmulatorOptions
from robots.drivers.robotiq.gripper_registers import ACTIVATE, GripperCommand


class GripperFaults:
    """Executes the requests of the side channel: `do` names what, further keys its values.

    cut, freeze, garbage, refuse: as `WireFaults`. slow: `seconds`. object, ring: `width_m`, null for nothing.
    fault: `code`, 0 for none. restart: power off and on. foreign: another client moves to `position`, with `go`.
    restore: no fault of the wire. state: the true state.
    """

    def __init__(self, bank: RegisterBank, stream: TcpStream | PtyStream, faults: WireFaults) -> None:
        self._bank = bank
        self._stream = stream
        self._faults = faults

    async def execute(self, request: Request) -> Mapping[str, object]:
        """Execute one request; raises KeyError, TypeError or ValueError for what is not one."""
        gripper, faults = self._bank.gripper, self._faults
        gripper.advance()
        match str(request["do"]):
            case "cut":
                faults.cut = True
                await self._stream.close()
            case "freeze":
                faults.frozen = True
            case "garbage":
                faults.garbage = True
            case "refuse":
                faults.refuse = True
            case "slow":
                faults.slow_s = _number(request["seconds"])
            case "restore":
                was_cut = faults.cut
                faults.cut = faults.frozen = faults.garbage = faults.refuse = False
                faults.slow_s = 0.0
                if was_cut:
                    await self._stream.open()
            case "object":
                gripper.object_m = _width(request["width_m"])
            case "ring":
                gripper.ring_m = _width(request["width_m"])
            case "fault":
                gripper.fault = int(_number(request["code"]))
            case "restart":
                gripper.restart()
                await self._stream.close()
                await self._stream.open()
            case "foreign":
                position, go = int(_number(request["position"])), bool(request.get("go", True))
                self._bank.take(GripperCommand(activate=True, go=go, position=position, speed=255, force=0))
            case "state":
                return self._state()
            case other:
                raise ValueError(f"{other} is not known")
        return {"ok": True}

    def _state(self) -> Mapping[str, object]:
        gripper = self._bank.gripper
        status = gripper.status()
        return {
            "time_s": time.monotonic(),
            "width_m": gripper.width_m,
            "position": status.position,
            "active": status.active,
            "go": status.go,
            "contact": status.contact.name,
            "fault": status.fault,
            "travel": gripper.travel,
            "commands": gripper.commands,
            "stopped_s": gripper.stopped_s,
            "rested_s": gripper.rested_s,
            "clients": self._stream.clients,
        }


async def serve_gripper(options: RobotiqEmulatorOptions, ready: Ready) -> None:
    """Serve until this is cancelled; `ready` receives where."""
    faults = WireFaults()
    gripper = EmulatedGripper(time.monotonic, activation_s=0.0 if options.active else options.activation_s)
    gripper.object_m = options.object_m if options.object_m >= 0.0 else None
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
        gripper.travel, gripper.commands = 0.0, 0
    stream = (
        PtyStream(new_session, faults)
        if options.connection == "serial"
        else TcpStream(new_session, faults, host=options.host, port=options.port)
    )
    side = SideChannel(GripperFaults(bank, stream, faults).execute, host=options.host, port=options.side_port)
    place = await stream.open()
    ready({"connection": options.connection, **place, "side_port": await side.open()})
    try:
        await asyncio.Event().wait()
    finally:
        side.close()
        await stream.close()


def _number(value: object) -> float:
    if isinstance(value, bool) or not isinstance(value, int | float):
        raise TypeError(f"{value!r} is no number")
    return float(value)


def _width(value: object) -> float | None:
    return None if value is None else _number(value)
