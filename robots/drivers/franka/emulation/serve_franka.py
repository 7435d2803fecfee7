"""Serves an emulated control cabinet until it is cancelled."""

from __future__ import annotations

import asyncio

from engine.cell.drivers import Ready
from robots.drivers.emulation.side_channel import SideChannel
from robots.drivers.franka.emulation.control_cabinet import ARM_PORT, HAND_PORT, ControlCabinet
from robots.drivers.franka.emulation.franka_emulator import FrankaEmulatorOptions


async def serve_franka(options: FrankaEmulatorOptions, ready: Ready) -> None:
    """Serve one robot, and say where it listens; raises CellError."""
    cabinet = ControlCabinet(options)
    side = SideChannel(cabinet.execute, host=options.host, port=options.side_port)
    try:
        await cabinet.open()
        ready(
            {
                "connection": "fci",
                "host": options.host,
                "arm": ARM_PORT,
                "hand": HAND_PORT,
                "side_port": await side.open(),
            }
        )
        await asyncio.Event().wait()
    finally:
        side.close()
        await cabinet.close()
