"""The planning scene of an open cell: what it has, what may be put into it, what is held, what outlives the cell."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from engine.bus import SkillBus
from engine.cell.open_cell import OpenCell
from engine.errors import SkillFailed
from engine.messages import PartPoses, Pose
from engine.messages.shapes import AT_ORIGIN, Hull, Obstacle, Sphere
from engine.skill import Service
from engine.skills.gripper import GripperOpen
from engine.skills.motion import CartLinTask, JointTrapVel
from engine.skills.planning_scene import (
    AllowContact,
    AttachPart,
    CheckCollision,
    CollisionReport,
    DetachPart,
    ForgetOccupancy,
    PlanningSceneState,
    PutObstacle,
    ReadPlanningScene,
    RemoveObstacle,
)
from engine.skills.simulated_world import PushBody
from tests.robots.sim.demo_cell import LIFT, PICK, opened_cell, pick
from tests.robots.workspace.free_cell import POST, THERE, box, free, free_cell

PART = "hca_north"


async def scene(bus: SkillBus) -> PlanningSceneState:
    """Return the scene."""
    return await bus.call(ReadPlanningScene(), to="cell")


async def ask(bus: SkillBus, request: Service[Any]) -> Any:
    """Ask a service of the cell."""
    return await bus.call(request, to="cell")


def names(state: PlanningSceneState) -> set[str]:
    """Return the names of the obstacles."""
    return {obstacle.name for obstacle in state.obstacles}


def where(state: PlanningSceneState, name: str) -> Pose:
    """Return where an obstacle is."""
    (found,) = (obstacle.pose for obstacle in state.obstacles if obstacle.name == name)
    return found


def part_pose(bus: SkillBus) -> Pose:
    """Return where the physics has the part."""
    parts = bus.topic("cell/parts", PartPoses).latest
    assert parts is not None
    return parts.poses[PART]


async def held_up(cell: OpenCell) -> None:
    """Pick the part, attach it and lift it."""
    await pick(cell.bus)
    await ask(cell.bus, AttachPart(part=PART, robot="left"))
    await cell.bus.send_goal(LIFT, to="left").result()


@pytest.mark.virtual
async def test_fixtures_and_parts_are_in_the_scene_parts_where_they_lie_now(tmp_path: Path) -> None:
    async with opened_cell(tmp_path) as cell:
        before = await scene(cell.bus)
        assert names(before) == {"table", "tray_north", "tray_south", "hca_north", "hca_south"}
        await cell.bus.call(PushBody(body=PART, force_n=(0.0, 2.0, 0.0), duration_s=0.3), to="cell")
        await cell.bus.clock.sleep(1.0)
        after = await scene(cell.bus)
        moved = where(after, PART).xyz[1] - where(before, PART).xyz[1]
        assert (moved > 0.01, after.revision > before.revision) == (True, True)
        assert where(after, PART).xyz == pytest.approx(part_pose(cell.bus).xyz, abs=0.001)
        assert where(after, "hca_south") == where(before, "hca_south")
        assert (await scene(cell.bus)).revision == after.revision


@pytest.mark.virtual
async def test_obstacles_are_put_replaced_and_removed_and_the_topic_tells(tmp_path: Path) -> None:
    async with opened_cell(tmp_path) as cell:
        bus = cell.bus
        told: list[PlanningSceneState] = []
        subscription = bus.topic("cell/planning_scene", PlanningSceneState).subscribe(told.append)
        put = await ask(bus, PutObstacle(obstacle=POST))
        assert (where(put, "post"), told[-1]) == (POST.pose, put)
        again = await ask(bus, PutObstacle(obstacle=box("post", (0.1, 0.1, 0.1), (0.0, 0.0, 1.0))))
        assert where(again, "post").xyz == (0.0, 0.0, 1.0)
        assert "post" not in names(await ask(bus, RemoveObstacle(name="post")))
        last = await ask(bus, RemoveObstacle(name="post"))
        assert last == told[-1]
        assert [state.revision for state in told] == sorted({state.revision for state in told})
        subscription.close()


@pytest.mark.virtual
@pytest.mark.parametrize(
    ("request_", "words"),
    [
        (RemoveObstacle(name="pots"), "no obstacle called pots"),
        (RemoveObstacle(name=PART), "whose pose is measured"),
        (PutObstacle(obstacle=Obstacle.of(PART, Sphere(radius_m=0.1), AT_ORIGIN)), "whose pose is measured"),
        (PutObstacle(obstacle=Obstacle.of("left", Sphere(radius_m=0.1), AT_ORIGIN)), "name left is reserved"),
        (PutObstacle(obstacle=Obstacle.of("ball", Sphere(radius_m=-0.1), AT_ORIGIN)), "ball"),
        (PutObstacle(obstacle=Obstacle.of("ball", Sphere(radius_m=float("nan")), AT_ORIGIN)), "ball"),
        (PutObstacle(obstacle=Obstacle.of("flat", Hull(points_m=((0.0, 0.0, 0.0),) * 4), AT_ORIGIN)), "flat"),
        (PutObstacle(obstacle=Obstacle(name="nothing", solids=())), "nothing"),
        (PutObstacle(obstacle=box("far", (0.1, 0.1, 0.1), (float("inf"), 0.0, 0.0))), "far"),
        (AllowContact(first="left", second="tabel"), "did you mean table"),
        (AllowContact(first="left/panda_hnd", second="table"), "no link of left called panda_hnd"),
        (AttachPart(part="hca", robot="left"), "no part called hca"),
        (AttachPart(part="table", robot="left"), "table is a fixture"),
        (AttachPart(part=PART, robot="lft"), "no arm called lft"),
        (AttachPart(part=PART, robot="left", link="panda_elbow"), "no link of left called panda_elbow"),
        (DetachPart(part="hca"), "no object called hca"),
        (CheckCollision(robot="lft"), "lft"),
        (CheckCollision(robot="left", joints=(0.0, 1.0)), "joints"),
        (CheckCollision(robot="left", joints=(float("nan"),) * 7), "joints"),
    ],
    ids=str,
)
async def test_what_makes_no_sense_is_refused_in_words_and_changes_nothing(
    tmp_path: Path, request_: Service[Any], words: str
) -> None:
    async with opened_cell(tmp_path) as cell:
        before = await scene(cell.bus)
        with pytest.raises(SkillFailed, match=words):
            await ask(cell.bus, request_)
        assert await scene(cell.bus) == before


@pytest.mark.virtual
async def test_a_collision_is_named_and_may_be_allowed(tmp_path: Path) -> None:
    async with free_cell(tmp_path) as opened:
        bus = opened.bus
        await opened.go(THERE)
        free_report: CollisionReport = await ask(bus, CheckCollision(robot="left"))
        assert free_report.touching == ()
        hand = box("hand", (0.1, 0.1, 0.1), opened.tool_xyz())
        await opened.put(hand)
        report: CollisionReport = await ask(bus, CheckCollision(robot="left"))
        assert ("left/panda_hand", "hand") in {(pair.first, pair.second) for pair in report.touching}
        await ask(bus, AllowContact(first="left", second="hand"))
        assert (await ask(bus, CheckCollision(robot="left"))).touching == ()
        await ask(bus, AllowContact(first="left", second="hand", allowed=False))
        assert (await ask(bus, CheckCollision(robot="left"))).touching != ()


@pytest.mark.virtual
async def test_an_attached_part_moves_along_and_may_touch_what_it_lay_on_until_it_is_lifted(tmp_path: Path) -> None:
    async with opened_cell(tmp_path) as cell:
        bus = cell.bus
        await pick(bus)
        state = await ask(bus, AttachPart(part=PART, robot="left"))
        assert (PART in names(state), state.held[0].name, state.held[0].robot) == (False, PART, "left")
        assert (PART, "tray_north") in state.allowed
        assert (await ask(bus, CheckCollision(robot="left"))).touching == ()
        await bus.send_goal(LIFT, to="left").result()
        lifted = await scene(bus)
        assert (lifted.held[0].name, [pair for pair in lifted.allowed if PART in pair]) == (PART, [])
        await ask(bus, PutObstacle(obstacle=box("plate", (0.1, 0.1, 0.01), part_pose(bus).xyz)))
        touching = {(pair.first, pair.second) for pair in (await ask(bus, CheckCollision(robot="left"))).touching}
        assert (PART, "plate") in touching or ("plate", PART) in touching


@pytest.mark.virtual
async def test_a_part_that_is_put_down_stays_there_and_the_fingers_may_touch_it_until_they_have_left(
    tmp_path: Path,
) -> None:
    async with opened_cell(tmp_path) as cell:
        bus = cell.bus
        await held_up(cell)
        await bus.send_goal(CartLinTask(pose=PICK, duration_s=1.0), to="left").result()
        down = await ask(bus, DetachPart(part=PART))
        assert (down.held, where(down, PART).xyz) == ((), pytest.approx(part_pose(bus).xyz, abs=0.002))
        assert {pair[1] for pair in down.allowed if pair[0] == PART} >= {
            "left/panda_leftfinger",
            "left/panda_rightfinger",
        }
        assert (await ask(bus, CheckCollision(robot="left"))).touching == ()
        await bus.send_goal(GripperOpen(), to="left/gripper").result()
        await bus.send_goal(LIFT, to="left").result()
        left = await scene(bus)
        assert [pair for pair in left.allowed if PART in pair] == []
        assert await ask(bus, DetachPart(part=PART)) == left


@pytest.mark.virtual
async def test_a_part_that_the_gripper_loses_is_where_the_physics_has_it(
    tmp_path: Path, caplog: pytest.LogCaptureFixture
) -> None:
    async with opened_cell(tmp_path) as cell:
        bus = cell.bus
        await held_up(cell)
        await bus.send_goal(GripperOpen(), to="left/gripper").result()
        await bus.clock.sleep(1.0)
        state = await scene(bus)
        assert (state.held, where(state, PART).xyz) == ((), pytest.approx(part_pose(bus).xyz, abs=0.002))
        assert "left has lost hca_north" in caplog.text


@pytest.mark.virtual
async def test_an_obstacle_that_is_attached_can_be_carried_and_put_elsewhere(tmp_path: Path) -> None:
    """One that only the scene knows, as a tool that the simulation has not."""
    async with free_cell(tmp_path) as opened:
        bus = opened.bus
        await opened.go(THERE)
        await opened.put(box("torch", (0.02, 0.02, 0.1), opened.tool_xyz()))
        await ask(bus, AttachPart(part="torch", robot="left", link="panda_hand"))
        await bus.send_goal(JointTrapVel(joints=(0.3, *THERE[1:]), speed=0.5), to="left").result()
        state = await ask(bus, DetachPart(part="torch"))
        assert where(state, "torch").xyz == pytest.approx(opened.tool_xyz(), abs=0.005)


@pytest.mark.virtual
async def test_a_part_goes_over_from_one_arm_to_the_other(tmp_path: Path) -> None:
    async with opened_cell(tmp_path) as cell:
        await ask(cell.bus, AttachPart(part=PART, robot="left"))
        state = await ask(cell.bus, AttachPart(part=PART, robot="right"))
        assert [(held.name, held.robot) for held in state.held] == [(PART, "right")]
        assert await ask(cell.bus, AttachPart(part=PART, robot="right")) == state


@pytest.mark.virtual
async def test_what_was_put_held_and_allowed_outlives_the_cell(tmp_path: Path) -> None:
    async with opened_cell(tmp_path, seed=3) as cell:
        await held_up(cell)
        await ask(cell.bus, PutObstacle(obstacle=POST))
        await ask(cell.bus, AllowContact(first="post", second="right"))
        await ask(cell.bus, RemoveObstacle(name="tray_south"))
        before = await scene(cell.bus)
        snapshot = await cell.snapshot()
    assert snapshot is not None
    async with opened_cell(tmp_path, seed=3) as cell:
        await cell.restore(snapshot)
        after = await scene(cell.bus)
        assert (names(after), after.allowed) == (names(before), before.allowed)
        assert [(held.name, held.robot) for held in after.held] == [(PART, "left")]
        assert (await cell.snapshot()) is not None
        assert (await cell.bus.send_goal(free(THERE, speed=0.2), to="left").result()).result is not None
        assert [held.name for held in (await scene(cell.bus)).held] == [PART]


@pytest.mark.virtual
async def test_a_scene_that_nobody_has_touched_is_no_part_of_a_snapshot(tmp_path: Path) -> None:
    async with opened_cell(tmp_path, seed=3) as cell:
        snapshot = await cell.snapshot()
        await scene(cell.bus)
        assert await cell.snapshot() == snapshot


@pytest.mark.virtual
async def test_forgetting_what_the_cameras_saw_is_no_error_without_cameras(tmp_path: Path) -> None:
    async with opened_cell(tmp_path) as cell:
        assert await ask(cell.bus, ForgetOccupancy()) == await scene(cell.bus)
