"""Starts the emulator of a Universal Robots controller, and prints a line of JSON when it listens."""

from __future__ import annotations

import argparse
import asyncio
import signal
import sys

import msgspec

from robots.drivers.universal_robots.emulator.controller_emulator import ControllerEmulator, EmulatorPorts
from robots.drivers.universal_robots.emulator.ur_models import ARMS, SERIES


async def emulate(*, host: str, model: str, series: str) -> None:
    """Serve one controller until SIGTERM or SIGINT."""
    emulator = ControllerEmulator(model=model, series=series)
    ports = EmulatorPorts()
    stopped = asyncio.Event()
    for number in (signal.SIGTERM, signal.SIGINT):
        asyncio.get_running_loop().add_signal_handler(number, stopped.set)
    async with emulator.listening(host, ports):
        cycles = asyncio.create_task(emulator.run())
        ready = {
            "ready": True,
            "host": host,
            "model": model,
            "series": series,
            "rtde": ports.rtde,
            "dashboard": ports.dashboard,
            "scripts": ports.scripts,
            "side_channel": ports.side_channel,
        }
        sys.stdout.write(msgspec.json.encode(ready).decode() + "\n")
        sys.stdout.flush()
        waiting = asyncio.create_task(stopped.wait())
        done, pending = await asyncio.wait({cycles, waiting}, return_when=asyncio.FIRST_COMPLETED)
        for task in pending:
            task.cancel()
        for task in done:
            task.result()


def main() -> None:
    """Read the options and serve."""
    parser = argparse.ArgumentParser(prog="python -m robots.drivers.universal_robots.emulator", description=__doc__)
    parser.add_argument("--host", default="127.0.0.5", help="an address of its own, as ports are fixed")
    parser.add_argument("--model", default="ur10", choices=sorted(ARMS))
    parser.add_argument("--series", default="cb3", choices=sorted(SERIES), help="cb3: 125 Hz; e: 500 Hz")
    options = parser.parse_args()
    asyncio.run(emulate(host=options.host, model=options.model, series=options.series))


if __name__ == "__main__":
    main()
