"""Modules of an open cell on the bus: what is told of them, what follows at once, and what is refused."""

from __future__ import annotations

import asyncio
import os
import signal
from collections.abc import AsyncGenerator
from contextlib import asynccontextmanager
from pathlib import Path

import pytest

from engine.bus import GoalStatus, SkillBus
from engine.bus.lease import Holder
from engine.cell.open_cell import OpenCell
from engine.clock import new_clock
from engine.document.cell import Cell
from engine.errors import LeaseRefused, SkillFailed
from engine.messages import FramePoses, JointState, PartPoses, Pose, SceneDescription
from engine.robot import DeviceStatus
from engine.skills.modules import MODULES_TOPIC, CellModules, ModuleState, PlugModule, UnplugModule
from engine.skills.motion import CartTrapVel, JointTrapVel
from engine.skills.planning_scene import AttachPart, PlanningSceneState, ReadPlanningScene
from engine.skills.simulated_world import ResetParts
from robots.sim.commands.world_commands import ModulePlaced, PlaceModule
from robots.sim.host.lockstep_host import LockstepHost
from robots.sim.host.process_host import ProcessHost
from robots.sim.world.sim_world import SimWorld
from tests.robots.module_cell import CELL, MODULE, module_cell, module_scene

AWAY = ("full/block", "full/ball")
UPPER = """\
  upper: {module: bin, plugged: false}
"""
DOWN = (1.0, 0.0, 0.0, 0.0)


@asynccontextmanager
async def opened(cell: Cell) -> AsyncGenerator[OpenCell]:
    """Open a cell."""
    async with OpenCell(cell) as found:
        yield found


def names_in_scene(bus: SkillBus) -> set[str]:
    """Return the names of all that is drawn."""
    scene = bus.topic("cell/scene", SceneDescription).latest
    assert scene is not None
    return {each.name for each in scene.geometries}


def part_places(bus: SkillBus) -> dict[str, Pose]:
    """Return where the parts of the cell are."""
    parts = bus.topic("cell/parts", PartPoses).latest
    assert parts is not None
    return dict(parts.poses)


def frames(bus: SkillBus) -> tuple[str, ...]:
    """Return the names of all frames."""
    found = bus.topic("cell/frames", FramePoses).latest
    assert found is not None
    return found.names


async def obstacles(bus: SkillBus) -> set[str]:
    """Return the names of what planners avoid."""
    state = await bus.call(ReadPlanningScene(), to="cell")
    return {one.name for one in state.obstacles}


def modules(bus: SkillBus) -> CellModules:
    """Return the state of the modules."""
    latest = bus.topic(MODULES_TOPIC, CellModules).latest
    assert latest is not None
    return latest


@pytest.mark.virtual
async def test_what_stands_on_a_module_is_everywhere_at_once_and_goes_with_it(tmp_path: Path) -> None:
    async with opened(module_cell(tmp_path)) as cell:
        bus = cell.bus
        unplugged = (
            ModuleState(module="full", kind="bin", away=AWAY),
            ModuleState(module="other", kind="bin", away=("other/block", "other/ball")),
        )
        assert modules(bus) == CellModules(modules=unplugged, free=("dock_1", "dock_2"))
        assert (set(part_places(bus)), await obstacles(bus)) == ({"own"}, {"table", "own"})
        before = await bus.call(ReadPlanningScene(), to="cell")
        state = await bus.call(PlugModule(), to="full")
        assert state == ModuleState(module="full", kind="bin", connector="dock_1")
        assert modules(bus) == CellModules(modules=(state, unplugged[1]), free=("dock_2",))
        assert part_places(bus)["full/block"].xyz == pytest.approx((0.54, 0.4, 0.225))
        assert set(part_places(bus)) == {"own", *AWAY}
        assert await obstacles(bus) == {"table", "own", "full/tray", *AWAY}
        published = bus.topic("cell/planning_scene", PlanningSceneState).latest
        assert published is not None
        assert published.revision > before.revision
        assert {"full/tray/0", "full/block", "full/ball"} <= names_in_scene(bus)
        assert {"full", "full/slot_1", "full/block"} <= set(frames(bus))
        await bus.clock.sleep(0.5)
        assert part_places(bus)["full/block"].xyz == pytest.approx((0.54, 0.4, 0.225), abs=1e-3)
        assert await bus.call(UnplugModule(), to="full") == unplugged[0]
        assert modules(bus) == CellModules(modules=unplugged, free=("dock_1", "dock_2"))
        assert (set(part_places(bus)), await obstacles(bus)) == ({"own"}, {"table", "own"})
        assert not any(name.startswith("full") for name in (*frames(bus), *names_in_scene(bus)))


@pytest.mark.virtual
async def test_an_arm_moves_to_a_slot_where_its_module_is_now(tmp_path: Path) -> None:
    async with opened(module_cell(tmp_path)) as cell:
        bus = cell.bus
        above = CartTrapVel(pose=Pose(xyz=(0.0, 0.0, 0.3), xyzw=DOWN, frame="other/slot_1"), speed=0.5)
        refused = await bus.send_goal(above, to="right").result()
        assert refused.status is not GoalStatus.SUCCEEDED
        assert "other/slot_1" in str(refused.cause)
        await bus.call(PlugModule(connector="dock_2"), to="other")
        end = await bus.send_goal(above, to="right").result()
        assert end.result is not None
        assert end.result.pose.xyz == pytest.approx((0.6, -0.46, 0.505), abs=3e-3)


@pytest.mark.virtual
async def test_each_refusal_says_what_to_do_and_changes_nothing(tmp_path: Path) -> None:
    carried = CELL.replace("other: {module: bin, plugged: false}", "other: {module: bin, plugged: false}\n" + UPPER)
    carried = carried.replace("modules:", "  on_top: {parent: full/slot_2, at: {xyz: [0, 0, 0.3]}}\nmodules:")
    async with opened(module_cell(tmp_path, cell=carried)) as cell:
        bus = cell.bus

        async def refusal(request: PlugModule | UnplugModule, module: str) -> str:
            before = modules(bus)
            with pytest.raises(SkillFailed) as refused:
                await bus.call(request, to=module)
            assert modules(bus) == before
            return str(refused.value)

        assert await refusal(PlugModule(), "other") == (
            "cell: other has no connector in the cell document (name one of dock_1, dock_2)"
        )
        assert await refusal(PlugModule(connector="dock_3"), "other") == (
            "cell: the cell has no connector dock_3 (did you mean dock_2 or dock_1?)"
        )
        assert await refusal(UnplugModule(), "full") == "cell: full is not plugged (plugged are none)"
        assert await refusal(PlugModule(connector="on_top"), "upper") == (
            "cell: on_top is on full, which is not plugged (plug full first)"
        )
        await bus.call(PlugModule(), to="full")
        assert await refusal(PlugModule(connector="dock_2"), "full") == (
            "cell: full is plugged to dock_1 already (unplug it first)"
        )
        assert await refusal(PlugModule(connector="dock_1"), "other") == (
            "cell: full is plugged to dock_1 (unplug full, or choose one of dock_2, on_top)"
        )
        await bus.call(PlugModule(connector="on_top"), to="upper")
        assert part_places(bus)["upper/block"].xyz == pytest.approx((0.6, 0.4, 0.53))
        assert await refusal(UnplugModule(), "full") == (
            "cell: full cannot be unplugged: upper is plugged to it (unplug upper first)"
        )
        await bus.call(UnplugModule(), to="upper")
        await bus.call(UnplugModule(), to="full")


@pytest.mark.virtual
async def test_what_a_run_has_plugged_nobody_else_unplugs(tmp_path: Path) -> None:
    async with opened(module_cell(tmp_path)) as cell:
        bus = cell.bus
        run = Holder("run-1", "root/plug")
        bus.leases.acquire(("full",), run)
        await bus.call(PlugModule(), to="full", holder=run)
        bus.leases.release(("full",), run)
        with pytest.raises(LeaseRefused, match="run-1"):
            await bus.call(UnplugModule(), to="full")
        assert modules(bus).modules[0].connector == "dock_1"
        bus.leases.release_run("run-1")
        await bus.call(UnplugModule(), to="full")


@pytest.mark.virtual
async def test_a_robot_that_stands_on_a_module_and_cameras_keep_it_where_it_is(tmp_path: Path) -> None:
    fixed = CELL.replace("connector: dock_1, plugged: false", "connector: dock_1").replace(
        "base: {xyz: [0, 0.4, 0]}", "base: {frame: full, xyz: [0.0, 0.5, 0]}"
    )
    async with opened(module_cell(tmp_path, cell=fixed)) as cell:
        with pytest.raises(SkillFailed, match="robot left stands on it"):
            await cell.bus.call(UnplugModule(), to="full")
    seeing = MODULE + "cameras:\n  eye: {at: [0.3, 0.3, 0.8], look_at: [0, 0, 0]}\n"
    plugged = CELL.replace("connector: dock_1, plugged: false", "connector: dock_1")
    plugged = plugged.replace("other: {module: bin, plugged: false}", "other: {module: bin, connector: dock_2}")
    async with opened(module_cell(tmp_path, cell=plugged, module=seeing)) as cell:
        with pytest.raises(SkillFailed, match="full carries cameras"):
            await cell.bus.call(UnplugModule(), to="full")


@pytest.mark.virtual
async def test_a_reopened_cell_has_the_modules_of_its_snapshot(tmp_path: Path) -> None:
    async with opened(module_cell(tmp_path)) as cell:
        await cell.bus.call(PlugModule(connector="dock_2"), to="full")
        await cell.bus.clock.sleep(0.3)
        snapshot, block = await cell.snapshot(), part_places(cell.bus)["full/block"]
    assert snapshot is not None
    async with opened(module_cell(tmp_path)) as cell:
        await cell.restore(snapshot)
        assert modules(cell.bus).modules[0].connector == "dock_2"
        assert part_places(cell.bus)["full/block"].xyz == pytest.approx(block.xyz, abs=1e-6)
        assert await obstacles(cell.bus) == {"table", "own", "full/tray", *AWAY}
        with pytest.raises(SkillFailed, match="full is plugged to dock_2"):
            await cell.bus.call(PlugModule(connector="dock_2"), to="other")


class SlowHost(LockstepHost):
    """A world that has placed a module a while before it answers."""

    async def place_module(self, command: PlaceModule) -> ModulePlaced:
        placed = await super().place_module(command)
        await asyncio.sleep(0.1)
        return placed


@pytest.mark.virtual
async def test_a_plug_whose_caller_is_cancelled_is_known_all_the_same(tmp_path: Path) -> None:
    cell = module_cell(tmp_path)
    scene = module_scene(cell)
    async with SimWorld(scene, host=SlowHost(scene), cell=cell) as world, SkillBus(new_clock()) as bus:
        world.register(bus)
        calling = asyncio.create_task(bus.call(PlugModule(), to="full"))
        await asyncio.sleep(0.05)
        calling.cancel()
        with pytest.raises(asyncio.CancelledError):
            await calling
        assert await bus.call(PlugModule(connector="dock_2"), to="other") is not None
        assert [each.connector for each in modules(bus).modules] == ["dock_1", "dock_2"]
        assert {*AWAY, "other/block"} <= set(part_places(bus))


@pytest.mark.virtual
async def test_a_snapshot_from_the_middle_of_a_plug_has_what_physics_has(tmp_path: Path) -> None:
    """The world's process may die after it has placed a module and before anybody heard of it."""
    nested = CELL.replace("other: {module: bin, plugged: false}", "other: {module: bin, plugged: false}\n" + UPPER)
    nested = nested.replace("modules:", "  on_top: {parent: full/slot_2, at: {xyz: [0, 0, 0.3]}}\nmodules:")
    async with opened(module_cell(tmp_path, cell=nested)) as cell:
        world = cell.world
        assert isinstance(world, SimWorld)
        await cell.bus.call(PlugModule(connector="dock_2"), to="full")
        pose = next(pose for name, pose in world.modules.frames.items() if name == "on_top")
        await world.host.place_module(PlaceModule(module="upper", pose=pose))
        assert "upper/block" not in part_places(cell.bus)
        await cell.restore(world.snapshot())
        assert [each.connector for each in modules(cell.bus).modules] == ["dock_2", "", "on_top"]
        assert {"upper/block", "upper/ball"} <= set(part_places(cell.bus))
        assert "upper/tray" in await obstacles(cell.bus)


@pytest.mark.virtual
async def test_reset_parts_go_back_to_their_modules_wherever_these_are(tmp_path: Path) -> None:
    async with opened(module_cell(tmp_path)) as cell:
        bus = cell.bus
        await bus.call(PlugModule(connector="dock_2"), to="full")
        await bus.clock.sleep(0.2)
        assert (await bus.call(ResetParts(), to="cell")).parts == ("own", *AWAY)
        assert part_places(bus)["full/block"].xyz == pytest.approx((0.6, -0.46, 0.225), abs=1e-3)


@pytest.mark.virtual
async def test_what_an_arm_has_attached_is_forgotten_with_its_module_and_is_an_obstacle_again(tmp_path: Path) -> None:
    """Attached by name only: no finger touches it, so that nothing keeps the module."""
    async with opened(module_cell(tmp_path)) as cell:
        bus = cell.bus
        await bus.call(PlugModule(), to="full")
        held = await bus.call(AttachPart(part="full/block", robot="left"), to="cell")
        assert [one.name for one in held.held] == ["full/block"]
        await bus.call(UnplugModule(), to="full")
        assert (await bus.call(ReadPlanningScene(), to="cell")).held == ()
        await bus.call(PlugModule(), to="full")
        assert "full/block" in await obstacles(bus)


async def test_in_real_time_arms_keep_moving_stop_and_the_modules_outlive_the_process(tmp_path: Path) -> None:
    patient = CELL.replace("{kind: mujoco}", "{kind: mujoco, engine_silence_s: 20, world_silence_s: 20}")
    async with opened(module_cell(tmp_path, cell=patient)) as cell:
        bus, world = cell.bus, cell.world
        assert isinstance(world, SimWorld)
        assert isinstance(world.host, ProcessHost)
        start = bus.topic("left/joint_state", JointState).latest
        assert start is not None
        goal = JointTrapVel(joints=tuple(joint + 0.2 for joint in start.position_rad), speed=0.1)
        moving = bus.send_goal(goal, to="left")
        for _ in range(3):
            await bus.call(PlugModule(), to="full")
            assert "full/block" in part_places(bus)
            await bus.call(UnplugModule(), to="full")
            assert "full/block" not in part_places(bus)
        assert (await moving.result()).status is GoalStatus.SUCCEEDED
        again = bus.send_goal(JointTrapVel(joints=start.position_rad, speed=0.05), to="left")
        await bus.call(PlugModule(), to="full")
        await cell.stop()
        assert (await again.result()).status is not GoalStatus.SUCCEEDED
        os.kill(world.host.pid, signal.SIGKILL)
        while world.status is not DeviceStatus.FAULT:
            await bus.clock.sleep(0.01)
        await cell.reconnect()
        assert modules(bus).modules[0].connector == "dock_1"
        assert part_places(bus)["full/block"].xyz == pytest.approx((0.54, 0.4, 0.225), abs=2e-3)
        await bus.call(UnplugModule(), to="full")
        assert "full/block" not in part_places(bus)
