"""Hexapods on the bus of an open cell: what is on a platform follows it, and moves are planned beforehand."""

from __future__ import annotations

from collections.abc import AsyncGenerator
from contextlib import asynccontextmanager
from pathlib import Path

import pytest

from engine.bus import SkillBus
from engine.cell.open_cell import OpenCell
from engine.document.cell import load_cell
from engine.errors import SkillFailed
from engine.messages import FramePoses, Pose, SceneDescription, Vector3
from engine.messages.pose_algebra import compose_poses
from engine.skills.device_moves import DeviceFault, DeviceReading, MoveDevice, SimulateDeviceFault
from engine.skills.hexapods import PlanHexapodMove, ReadHexapod
from engine.skills.planning_scene import ReadPlanningScene
from engine.skills.simulated_world import PushBody

HEXAPOD = Path(__file__).parents[3] / "behaviors" / "modules" / "hexapod"
CELL = f"""\
flexcell: 1
cell: bench
world: {{kind: mujoco}}
connectors: {{dock: {{at: {{xyz: [0.5, 0, 0.1]}}}}}}
modules: {{jig: {{module: {HEXAPOD}, connector: dock}}}}
"""
LEGS = "jig/legs"

pytestmark = pytest.mark.virtual


@asynccontextmanager
async def opened(folder: Path) -> AsyncGenerator[OpenCell]:
    """Open a cell with one hexapod."""
    (folder / "cell.yaml").write_text(CELL, encoding="utf-8")
    async with OpenCell(load_cell(folder / "cell.yaml")) as cell:
        yield cell


async def brakes(bus: SkillBus, position: str) -> None:
    """Release or lock the brakes."""
    end = await bus.send_goal(MoveDevice(position=position), to=LEGS).result()
    assert end.result is not None
    assert end.result.ended == "timed"


async def push(cell: OpenCell, *force_n: float) -> None:
    """Push the platform for a second."""
    x, y, z = force_n
    await cell.bus.call(PushBody(body="jig/platform", force_n=(x, y, z), duration_s=1.0), to="cell")
    await cell.bus.clock.sleep(1.5)


async def platform(bus: SkillBus) -> Pose:
    """Return where the platform is."""
    return (await bus.call(ReadHexapod(pose="level"), to=LEGS)).platform


def shown(bus: SkillBus, frame: str) -> Vector3:
    """Return where the cell shows a frame."""
    frames = bus.topic("cell/frames", FramePoses).latest
    assert frames is not None
    return frames.xyz[frames.names.index(frame)]


def on(pose: Pose, xyz: Vector3) -> Vector3:
    """Return a point on the platform in the world."""
    return compose_poses(pose, Pose(xyz=xyz)).xyz


async def test_frames_fixtures_and_planners_follow_a_platform_that_is_moved(tmp_path: Path) -> None:
    async with opened(tmp_path) as cell:
        await cell.bus.call(ReadPlanningScene(), to="cell")
        start = await platform(cell.bus)
        await brakes(cell.bus, "released")
        await push(cell, 18.0, 0.0, 0.0)
        now = await platform(cell.bus)
        assert now.xyz[0] - start.xyz[0] > 0.002
        assert shown(cell.bus, "jig/platform") == pytest.approx(now.xyz, abs=1e-6)
        assert shown(cell.bus, "jig/handle") == pytest.approx(on(now, (0.0, 0.0, 0.038)), abs=1e-6)
        assert shown(cell.bus, "jig/grip") == pytest.approx(on(now, (0.0, 0.0, 0.043)), abs=3e-5)
        assert shown(cell.bus, "jig/nest") == pytest.approx(on(now, (0.065, 0.0, 0.008)), abs=3e-5)
        scene = await cell.bus.call(ReadPlanningScene(), to="cell")
        handle = next(one.pose for one in scene.obstacles if one.name == "jig/handle")
        assert handle.xyz == pytest.approx(on(now, (0.0, 0.0, 0.038)), abs=1e-3)


async def test_what_moves_is_drawn_in_a_frame_of_its_own(tmp_path: Path) -> None:
    async with opened(tmp_path) as cell:
        scene = cell.bus.topic("cell/scene", SceneDescription).latest
        assert scene is not None
        drawn = {each.name: (each.frame, each.xyz) for each in scene.geometries}
        assert drawn["jig/base"] == ("world", (0.5, 0.0, 0.11))
        assert drawn["jig/handle"] == ("jig/handle", (0.0, 0.0, 0.0))


async def test_brakes_that_do_not_hold_and_brakes_without_air(tmp_path: Path) -> None:
    """Loose ones give way to a hand; without air they stay closed, and the pressure switch tells."""
    async with opened(tmp_path) as cell:
        loose = SimulateDeviceFault(fault=DeviceFault(brakes=False))
        start = await platform(cell.bus)
        await push(cell, 18.0, 0.0, 0.0)
        assert await platform(cell.bus) == start or (await platform(cell.bus)).xyz[0] - start.xyz[0] < 1e-4
        assert (await cell.bus.call(loose, to=LEGS)).success
        await push(cell, 18.0, 0.0, 0.0)
        assert (await platform(cell.bus)).xyz[0] - start.xyz[0] > 0.002
        assert not (await cell.bus.call(loose, to="jig/nest_clamp")).success
        assert (await cell.bus.call(SimulateDeviceFault(fault=DeviceFault(air=False)), to=LEGS)).success
        end = await cell.bus.send_goal(MoveDevice(position="released"), to=LEGS).result()
        assert end.result is not None
        assert end.result.ended == "no_air"


async def test_a_clamp_on_a_moved_platform_knows_its_place(tmp_path: Path) -> None:
    async with opened(tmp_path) as cell:
        await brakes(cell.bus, "released")
        await push(cell, 18.0, 0.0, 0.0)
        await brakes(cell.bus, "locked")
        await cell.bus.send_goal(MoveDevice(position="closed"), to="jig/nest_clamp").result()
        reading = cell.bus.topic("jig/nest_clamp/state", DeviceReading).latest
        assert reading is not None
        assert reading.axes["jaw"] == pytest.approx(0.06, abs=0.001)


async def test_a_move_is_planned_with_where_tool_and_platform_end(tmp_path: Path) -> None:
    async with opened(tmp_path) as cell:
        now = await platform(cell.bus)
        tool = compose_poses(now, Pose(xyz=(0.0, 0.0, 0.043), xyzw=(1.0, 0.0, 0.0, 0.0)))
        move = await cell.bus.call(PlanHexapodMove(pose="high", tool=tool), to=LEGS)
        assert (move.refused, move.released, move.locked) == ("", "released", "locked")
        assert move.platform.xyz == pytest.approx((0.5, 0.0, 0.315), abs=1e-4)
        assert move.tool.xyz == pytest.approx((0.5, 0.0, 0.358), abs=1e-4)
        assert move.bodies == ("jig/platform", "jig/handle", "jig/stop", "jig/clamp")


async def test_a_line_that_leaves_the_limits_is_refused_with_leg_and_amount(tmp_path: Path) -> None:
    """A tool that holds the platform far from its middle swings it out."""
    async with opened(tmp_path) as cell:
        far = compose_poses(await platform(cell.bus), Pose(xyz=(0.6, 0.0, 0.0)))
        move = await cell.bus.call(PlanHexapodMove(pose="turned", tool=far), to=LEGS)
        assert move.refused == ""
        far = compose_poses(await platform(cell.bus), Pose(xyz=(20.0, 0.0, 0.0)))
        move = await cell.bus.call(PlanHexapodMove(pose="turned", tool=far), to=LEGS)
        assert "% of the line: leg" in move.refused
        assert "mm longer than its 230.0 mm" in move.refused


async def test_an_unknown_pose_is_refused_with_the_nearest_name(tmp_path: Path) -> None:
    async with opened(tmp_path) as cell:
        with pytest.raises(SkillFailed, match="jig/legs has no pose hig") as raised:
            await cell.bus.call(ReadHexapod(pose="hig"), to=LEGS)
        assert "high" in str(raised.value.hint)


async def test_a_restored_cell_has_its_brakes_and_platform_as_before(tmp_path: Path) -> None:
    async with opened(tmp_path) as cell:
        await brakes(cell.bus, "released")
        await push(cell, 18.0, 0.0, 0.0)
        before = await platform(cell.bus)
        world = cell.world
        assert world is not None
        snapshot = world.snapshot()
        await brakes(cell.bus, "locked")
        await world.restore(snapshot)
        await cell.bus.clock.sleep(0.5)
        assert (await platform(cell.bus)).xyz == pytest.approx(before.xyz, abs=5e-5)
        await push(cell, -18.0, 0.0, 0.0)
        assert before.xyz[0] - (await platform(cell.bus)).xyz[0] > 0.002
