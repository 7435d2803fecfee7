"""Any datagrams at any port: no crash, no motion that nobody asked for, each one counted by name."""

from __future__ import annotations

import random
import struct
from collections.abc import Iterator

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from engine.clock import run_virtual
from engine.messages import RobotDescription
from robots.model import model_by_name
from robots.reconcell.command_interface import CommandInterface
from robots.reconcell.interface_options import InterfaceOptions
from robots.reconcell.packet_errors import REFUSALS
from robots.reconcell.packet_table import SPECS, command_ports, specs_of
from tests.robots.arm.served import Served, served
from tests.tiers import examples

PORTS = command_ports()
SENDERS = (("127.0.0.1", 4000), ("127.0.0.1", 4001))


def interface(cell: Served) -> CommandInterface:
    """Return the interface of the arm."""
    description = cell.bus.topic("left/description", RobotDescription).latest
    assert description is not None
    return CommandInterface(cell.bus, description, options=InterfaceOptions())


def packets(count: int, seed: int) -> Iterator[tuple[int, bytes]]:
    """Yield datagrams: any bytes, those of a right size, and right ones with one number changed.

    A mode is never among them, so that nothing asks for a motion.
    """
    dice = random.Random(seed)
    specs = [spec for spec in SPECS if spec.direction == "command" and spec.port != 10000]
    for _ in range(count):
        spec = dice.choice(specs)
        size = dice.choice(spec.layouts).size
        kind = dice.randrange(4)
        if kind == 0:
            yield dice.choice([*PORTS, 9999, 15000]), dice.randbytes(dice.choice([0, 1, 7, 8, 16, 64, 1472, 1600]))
        elif kind == 1:
            yield spec.port, dice.randbytes(size)
        else:
            numbers = [dice.choice([0.0, 1.0, 0.5, -0.5, 1e308, float("nan"), 184.0]) for _ in range(size // 8)]
            yield spec.port, struct.pack(f"<{size // 8}d", *numbers) if size >= 8 else dice.randbytes(size)


def mode_is_wrong(data: bytes) -> bool:
    """Whether these bytes select no mode."""
    return len(data) != 1 or data[0] not in {0, 4, 5, 11, 12, 13, 16, 101}


@pytest.mark.virtual
async def test_thousands_of_packets_without_a_mode_move_nothing_and_are_refused_by_name() -> None:
    count = examples(3_000, nightly=100_000)
    async with served(model=model_by_name("ur10")) as cell:
        commands = interface(cell)
        start = cell.port.sample().position_rad.copy()
        for number, (port, data) in enumerate(packets(count, seed=7)):
            if port == 10000 and not mode_is_wrong(data):
                continue
            commands.receive(port, data, SENDERS[number % 2])
            if number % 50 == 0:
                await cell.bus.clock.sleep(0.05)
                commands.look()
        await commands.commands.close()
        status = commands.status
        assert status.received > 0.99 * count
        assert set(status.refused) <= set(REFUSALS)
        assert status.refused["wrong size"] > 0.05 * count
        assert status.refused["not finite"] > 0.05 * count
        assert cell.port.motion is None
        assert np.abs(cell.port.sample().position_rad - start).max() == 0.0


@settings(max_examples=examples(300, nightly=5_000))
@given(st.lists(st.tuples(st.sampled_from(PORTS), st.binary(max_size=80)), max_size=20), st.booleans())
def test_any_bytes_at_any_port_are_taken_or_counted(datagrams: list[tuple[int, bytes]], two: bool) -> None:
    async def main() -> None:
        async with served(model=model_by_name("ur10")) as cell:
            commands = interface(cell)
            for number, (port, data) in enumerate(datagrams):
                commands.receive(port, data, SENDERS[number % (1 + two)])
            await cell.bus.clock.sleep(0.1)
            await commands.commands.close()
            assert commands.status.received == len(datagrams)
            assert set(commands.status.refused) <= set(REFUSALS)
            # A single byte may be that of gravity compensation, and is one with a probability that examples reach.
            asked = any(port == 10000 and not mode_is_wrong(data) for port, data in datagrams)
            assert asked or cell.port.motion is None

    run_virtual(main())


@pytest.mark.parametrize("port", PORTS)
def test_every_other_size_is_refused(port: int) -> None:
    async def main() -> None:
        async with served(model=model_by_name("ur10")) as cell:
            commands = interface(cell)
            sizes = {layout.size for spec in specs_of(port, "command") for layout in spec.layouts}
            wrong = [size for size in range(1600) if size not in sizes]
            for size in wrong:
                commands.receive(port, bytes(size), SENDERS[0])
            assert commands.status.refused == {"wrong size": len(wrong)}
            assert commands.status.commander == ""

    run_virtual(main())
