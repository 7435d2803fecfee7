"""Serves an emulated pigpiod, and its faults on the side channel, until it is cancelled."""

from __future__ import annotations

import time
from collections.abc import Mapping

from engine.cell.drivers import Ready
from robots.drivers.emulation.byte_stream import TcpStream
from robots.drivers.emulation.serve_emulator import execute_wire_fault, number, serve_emulator
from robots.drivers.emulation.side_channel import Request
from robots.drivers.emulation.wire_faults import WireFaults
from robots.drivers.equipment.emulation.emulated_pins import EmulatedPins, PigpioSession
from robots.drivers.equipment.emulation.pigpiod_emulator import PigpiodOptions


async def serve_pigpiod(options: PigpiodOptions, ready: Ready) -> None:
    """Serve until this is cancelled; `ready` receives where.

    The side channel: faults of the wire as `execute_wire_fault`; level: sets `pin` to `on`, from outside; state: the
    true state of `pin`, with the time (monotonic, s) at which it changed last.
    """
    faults = WireFaults()
    pins = EmulatedPins(time.monotonic)
    stream = TcpStream(lambda: PigpioSession(pins, lambda: faults.refuse), faults, host=options.host, port=options.port)

    async def execute(request: Request) -> Mapping[str, object]:
        match str(request["do"]):
            case "level":
                pins.set_level(int(number(request["pin"])), int(bool(request["on"])))
            case "state":
                pin = pins.pins[int(number(request["pin"]))]
                return {
                    "mode": pin.mode,
                    "level": pin.level,
                    "duty": pin.duty,
                    "changed_s": pin.changed_s,
                    "now_s": time.monotonic(),
                    "clients": stream.clients,
                }
            case _:
                await execute_wire_fault(request, faults, stream)
        return {"ok": True}

    await serve_emulator(stream, execute, ready, connection="pigpiod", host=options.host, side_port=options.side_port)
