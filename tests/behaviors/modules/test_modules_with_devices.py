"""The modules that ship with devices: each does in physics what its document says, with no code of its own."""

from __future__ import annotations

from collections.abc import AsyncGenerator
from contextlib import asynccontextmanager
from pathlib import Path

import pytest

from engine.bus import SkillBus
from engine.cell.open_cell import OpenCell
from engine.document.cell import load_cell
from engine.messages import FramePoses, PartPoses
from engine.skills.device_moves import DeviceFault, DeviceReading, MoveDevice, SimulateDeviceFault
from engine.skills.simulated_world import PushBody
from tests.behaviors.application import BEHAVIORS

CELL = """\
flexcell: 1
cell: bench
world: {{kind: mujoco}}
connectors: {{dock: {{}}}}
modules: {{m: {{module: {modules}/{module}, connector: dock}}}}
parts: {parts}
"""

pytestmark = pytest.mark.virtual


@asynccontextmanager
async def opened(folder: Path, module: str, parts: str = "{}") -> AsyncGenerator[OpenCell]:
    """Open a cell with a shipped module."""
    text = CELL.format(modules=BEHAVIORS / "modules", module=module, parts=parts)
    (folder / "cell.yaml").write_text(text, encoding="utf-8")
    async with OpenCell(load_cell(folder / "cell.yaml")) as cell:
        yield cell


async def move(bus: SkillBus, device: str, position: str) -> str:
    """Move a device and return how that ended."""
    end = await bus.send_goal(MoveDevice(position=position), to=device).result()
    assert end.result is not None
    return end.result.ended


def part(bus: SkillBus) -> tuple[float, float, float]:
    """Return where the part is."""
    parts = bus.topic("cell/parts", PartPoses).latest
    assert parts is not None
    return parts.poses["piece"].xyz


async def pulled(bus: SkillBus, *force_n: float) -> float:
    """Pull at the part for half a second and return how far it went, in metres."""
    before = part(bus)
    x, y, z = force_n
    await bus.call(PushBody(body="piece", force_n=(x, y, z), duration_s=0.5), to="cell")
    await bus.clock.sleep(0.5)
    return sum((b - a) ** 2 for a, b in zip(before, part(bus), strict=True)) ** 0.5


async def test_the_clamp_presses_the_part_on_its_base_and_keeps_it_without_air(tmp_path: Path) -> None:
    """Two faces with 80 N and a coefficient of 0.6 hold 96 N."""
    piece = "{piece: {shape: box, size_m: [0.05, 0.05, 0.04], mass_kg: 0.2, at: {xyz: [0, 0, 0.12]}}}"
    async with opened(tmp_path, "clamp", piece) as cell:
        assert await move(cell.bus, "m/plunger", "clamped") == "reached"
        assert await pulled(cell.bus, 70.0, 0.0, 0.0) < 0.002
        await cell.bus.call(SimulateDeviceFault(fault=DeviceFault(air=False)), to="m/plunger")
        assert await pulled(cell.bus, 70.0, 0.0, 0.0) < 0.002
        await cell.bus.call(SimulateDeviceFault(), to="m/plunger")
        assert await pulled(cell.bus, 115.0, 0.0, 0.0) > 0.02


async def test_a_clamp_without_a_part_is_noticed_by_its_sensor(tmp_path: Path) -> None:
    async with opened(tmp_path, "clamp") as cell:
        assert await move(cell.bus, "m/plunger", "clamped") == "stuck"
        found = cell.bus.topic("m/plunger/state", DeviceReading).latest
        assert found is not None
        assert (found.commanded, found.sensed) == ("clamped", "between")


async def test_the_chuck_holds_a_rod_also_without_air_until_it_is_opened(tmp_path: Path) -> None:
    """Two faces with 100 N and a coefficient of 0.4 hold 80 N."""
    piece = "{piece: {shape: box, size_m: [0.04, 0.03, 0.06], mass_kg: 0.2, at: {xyz: [0, 0, 0.13]}}}"
    async with opened(tmp_path, "chuck", piece) as cell:
        assert await move(cell.bus, "m/jaws", "closed") == "timed"
        assert await pulled(cell.bus, 0.0, 0.0, 60.0) < 0.002
        await cell.bus.call(SimulateDeviceFault(fault=DeviceFault(air=False)), to="m/jaws")
        assert await pulled(cell.bus, 0.0, 0.0, 60.0) < 0.002
        await cell.bus.call(SimulateDeviceFault(), to="m/jaws")
        assert await move(cell.bus, "m/jaws", "open") == "timed"
        assert await pulled(cell.bus, 0.0, 0.0, 5.0) > 0.05


async def test_the_rotary_block_turns_only_with_its_bolt_out(tmp_path: Path) -> None:
    async with opened(tmp_path, "rotary_block") as cell:
        assert await move(cell.bus, "m/turn", "turned_90") == "interlocked"
        assert await move(cell.bus, "m/bolt", "free") == "timed"
        assert await move(cell.bus, "m/turn", "turned_90") == "reached"
        frames = cell.bus.topic("cell/frames", FramePoses).latest
        assert frames is not None
        *_, z, w = frames.xyzw[frames.names.index("m/block")]
        assert (abs(z), abs(w)) == pytest.approx((0.7071, 0.7071), abs=0.01)


async def test_the_slide_carries_a_part_by_friction(tmp_path: Path) -> None:
    piece = "{piece: {shape: box, size_m: [0.05, 0.05, 0.04], mass_kg: 0.2, at: {xyz: [0, -0.13, 0.1415]}}}"
    async with opened(tmp_path, "slide", piece) as cell:
        assert await move(cell.bus, "m/carriage", "back") == "reached"
        await cell.bus.clock.sleep(0.3)
        assert part(cell.bus)[1] == pytest.approx(0.13, abs=0.02)
