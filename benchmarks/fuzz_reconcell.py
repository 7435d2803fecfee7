"""Hostile datagrams to the server of the ReconCell interface, in front of an arm whose motions would be seen."""

from __future__ import annotations

import random
import struct
import time
from collections import Counter

import numpy as np

from benchmarks.fuzz_packets import mutated
from engine.messages import RobotDescription
from robots.model import model_by_name
from robots.reconcell.command_interface import CommandInterface
from robots.reconcell.interface_options import InterfaceOptions
from robots.reconcell.packet_table import SPECS, command_ports
from tests.robots.arm.served import served

_MODE_PORT = 10000
_SENDERS = (("127.0.0.1", 4000), ("127.0.0.1", 4001))
_LOOK_EVERY = 200


async def fuzz_reconcell_server(packets: int, *, seed: int) -> tuple[Counter[str], bool, float]:
    """Feed the interface; return outcomes by name, whether the arm has moved, and how long it took.

    No mode is selected, without which nothing may move; whatever the interface raises is a crash, and ends this.
    """
    chance = random.Random(seed)
    specs = [spec for spec in SPECS if spec.direction == "command" and spec.port != _MODE_PORT]
    ports = [port for port in command_ports() if port != _MODE_PORT]
    valid = {
        spec.port: tuple(
            struct.pack(f"<{layout.size // 8}d", *([0.25] * (layout.size // 8))) for layout in spec.layouts
        )
        for spec in specs
    }
    async with served(model=model_by_name("ur10")) as cell:
        description = cell.bus.topic("left/description", RobotDescription).latest
        assert description is not None
        commands = CommandInterface(cell.bus, description, options=InterfaceOptions())
        start = np.array(cell.port.sample().position_rad)
        begun_s = time.perf_counter()
        for number in range(packets):
            port = chance.choice(ports)
            commands.receive(port, mutated(chance, valid[port]), _SENDERS[number % 2])
            if number % _LOOK_EVERY == 0:
                await cell.bus.clock.sleep(0.0)
                commands.look()
        seconds = time.perf_counter() - begun_s
        outcomes = Counter(commands.status.refused)
        outcomes[""] = packets - sum(outcomes.values())
        await commands.commands.close()
        moved = cell.port.motion is not None or bool((cell.port.sample().position_rad != start).any())
    return outcomes, moved, seconds
