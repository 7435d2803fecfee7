"""The state of an arm in the frame of its base, where that stands now: an arm may pull its base along."""

from __future__ import annotations

from pathlib import Path

import pytest

from engine.cell.open_cell import OpenCell
from engine.document.cell import load_cell
from engine.messages import RobotDescription
from engine.skills.device_moves import MoveDevice
from engine.skills.simulated_world import PushBody
from robots.reconcell.command_interface import CommandInterface
from robots.reconcell.interface_options import InterfaceOptions
from robots.reconcell.packet_codec import decode_packet
from robots.reconcell.packets import RobotStatePacket
from robots.reconcell.state_broadcast import StateBroadcast

CELL = Path(__file__).parents[3] / "behaviors" / "cells" / "linear_unit.yaml"


@pytest.mark.virtual
async def test_the_tool_keeps_its_place_in_the_frame_of_a_base_that_moves() -> None:
    async with OpenCell(load_cell(CELL)) as cell:
        description = cell.bus.topic("arm/description", RobotDescription).latest
        assert description is not None
        interface = CommandInterface(cell.bus, description, options=InterfaceOptions())
        broadcast = StateBroadcast(cell.bus, description, interface, order="xyzw")

        async def place() -> tuple[float, ...]:
            state = next(data for port, data in await broadcast.datagrams() if port == 15000)
            packet = decode_packet(15000, state, direction="state")[1]
            assert isinstance(packet, RobotStatePacket)
            return packet.position_m

        before = await place()
        await cell.bus.send_goal(MoveDevice(position="released"), to="rail").result()
        await cell.bus.call(PushBody(body="carriage", force_n=(0.0, 80.0, 0.0), duration_s=1.0), to="cell")
        await cell.bus.clock.sleep(2.0)
        await cell.bus.send_goal(MoveDevice(position="locked"), to="rail").result()
        latest = cell.bus.topic("arm/description", RobotDescription).latest
        assert latest is not None
        assert latest.base.xyz[1] - description.base.xyz[1] > 0.1
        assert await place() == pytest.approx(before, abs=2e-3)
