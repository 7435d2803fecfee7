"""Serves an emulated controller until it is cancelled."""

from __future__ import annotations

from engine.cell.drivers import Ready
from robots.drivers.emulation.plant import ALONE, Plant
from robots.drivers.universal_robots.emulator.controller_emulator import ControllerEmulator, EmulatorPorts
from robots.drivers.universal_robots.emulator.ur_emulator import UrEmulatorOptions


async def serve_controller(options: UrEmulatorOptions, ready: Ready, plant: Plant = ALONE) -> None:
    """Serve one controller, and say where it listens. It moves the joints of the plant, if it has some."""
    emulator = ControllerEmulator(model=options.model, series=options.series, plant=plant, tool_kg=options.tool_kg)
    ports = EmulatorPorts()
    async with emulator.listening(options.host, ports):
        ready(
            {
                "host": options.host,
                "model": options.model,
                "series": options.series,
                "rtde": ports.rtde,
                "dashboard": ports.dashboard,
                "scripts": ports.scripts,
                "side_channel": ports.side_channel,
            }
        )
        await emulator.run()
