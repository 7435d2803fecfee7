"""Serves the stream and the side channel of an emulator, and executes the faults of the wire that all have."""

from __future__ import annotations

import asyncio

from engine.cell.drivers import Ready
from robots.drivers.emulation.byte_stream import PtyStream, TcpStream
from robots.drivers.emulation.side_channel import Handler, Request, SideChannel
from robots.drivers.emulation.wire_faults import WireFaults


async def serve_emulator(
    stream: TcpStream | PtyStream, execute: Handler, ready: Ready, *, connection: str, host: str, side_port: int
) -> None:
    """Serve until this is cancelled; `ready` receives where."""
    side = SideChannel(execute, host=host, port=side_port)
    try:
        place = await stream.open()
        ready({"connection": connection, **place, "side_port": await side.open()})
        await asyncio.Event().wait()
    finally:
        side.close()
        await stream.close()


async def execute_wire_fault(request: Request, faults: WireFaults, stream: TcpStream | PtyStream) -> None:
    """Execute cut, freeze, garbage, refuse, slow (`seconds`), or restore, which ends them.

    Raises:
        ValueError: it is another request.
    """
    match str(request["do"]):
        case "cut":
            faults.cut = True
            await stream.close()
        case "freeze":
            faults.frozen = True
        case "garbage":
            faults.garbage = True
        case "refuse":
            faults.refuse = True
        case "slow":
            faults.slow_s = number(request["seconds"])
        case "restore":
            was_cut = faults.cut
            faults.cut = faults.frozen = faults.garbage = faults.refuse = False
            faults.slow_s = 0.0
            if was_cut:
                await stream.open()
        case other:
            raise ValueError(f"{other} is not known")


def number(value: object) -> float:
    """Return a number of a request; raises TypeError for what is none."""
    if isinstance(value, bool) or not isinstance(value, int | float):
        raise TypeError(f"{value!r} is no number")
    return float(value)
