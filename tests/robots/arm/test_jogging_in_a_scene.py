"""Jogging minds the planning scene: it stands before what it would touch, and goes away from it."""

from __future__ import annotations

import asyncio
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from engine.bus import GoalStatus, SkillBus
from engine.errors import RobotError, SkillFailed
from engine.messages import GripperState, Pose, Vector3
from engine.messages.shapes import Box, Obstacle
from engine.skill import Action
from engine.skills.jogging import (
    JogBlock,
    JogCollisionOptions,
    JogCommand,
    JogJoints,
    JogTool,
    PrepareJog,
    StepJoints,
    StepTool,
)
from engine.skills.motion import ForwardKinematics
from engine.skills.planning_scene import AttachPart, CheckCollision, CollisionReport, PutObstacle, RemoveObstacle
from robots.arm.jogging.directions_out import DirectionsOut
from robots.arm.scene_queries.scene_check import SceneCheck
from robots.planning.scene.planning_scene import NamePair
from robots.planning.worker import inline_planner
from robots.port import GraspCommand
from tests.robots.arm.simulated import Simulated, simulated
from tests.robots.fake_port import FakeStream
from tests.robots.workspace.fake_cell import FakeCell, fake_cell
from tests.tiers import nightly

DOWN = (0.0, 0.0, -0.25, 0.0, 0.0, 0.0)
STILL = (0.0,) * 7
ROUND = (1.2, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0)
MARGIN_M = JogCollisionOptions().margin_m


def put(name: str, size_m: Vector3, xyz: Vector3) -> PutObstacle:
    """A box along the world's axes."""
    return PutObstacle(obstacle=Obstacle.of(name, Box(size_m=size_m), Pose(xyz=xyz)))


async def near(cell: Simulated) -> CollisionReport:
    """What the arm is near to now."""
    return await cell.bus.call(CheckCollision(robot="left"), to="cell")


async def jogged(cell: Simulated, goal: Action[Any, Any]) -> tuple[str, float]:
    """Jog to the end; returns what held it back last, and how near it came to anything on its way, in metres."""
    handle = cell.bus.send_goal(goal, to="left")
    held: list[str] = []

    handle.on_feedback(lambda feedback: held.append(feedback.held_by))
    await handle.accepted()
    ending = asyncio.ensure_future(handle.result())
    nearest = np.inf
    while not ending.done():
        nearest = min(nearest, (await near(cell)).distance_m)
        await asyncio.wait((ending,), timeout=0.05)
    assert ending.result().status is GoalStatus.SUCCEEDED, ending.result().cause
    return next((reason for reason in reversed(held) if reason), ""), nearest


@pytest.mark.virtual
async def test_the_tool_commanded_through_the_table_stands_above_it() -> None:
    """As near as its rule allows, at 25 cm/s, without a contact; and it goes up again."""
    async with simulated() as cell:
        held_by, nearest_m = await jogged(cell, JogTool(velocity=DOWN, duration_s=4.0))
        stood = await near(cell)
        low = await cell.tool()
        up = await cell.perform(JogTool(velocity=(0.0, 0.0, 0.1, 0.0, 0.0, 0.0), duration_s=0.5))
        high = await cell.tool()
    assert "would touch table" in held_by
    assert nearest_m > 0.0
    assert stood.distance_m == pytest.approx(MARGIN_M, abs=0.006)
    assert up.status is GoalStatus.SUCCEEDED
    assert high.xyz[2] - low.xyz[2] > 0.03


@pytest.mark.virtual
@pytest.mark.parametrize("check_s", [0.1, 0.25])
async def test_checks_that_answer_late_let_no_jog_nearer(check_s: float, monkeypatch: pytest.MonkeyPatch) -> None:
    """On an overloaded machine; the arm gets there, slower, and not by a jerk a check.

    The distance is that of the lowest point of the tool on its way, so that no swing back hides how near it was.
    """
    async with simulated() as cell:
        held_by, _ = await jogged(cell, JogTool(velocity=DOWN, duration_s=4.0))
        lowest_m = (await cell.tool()).xyz[2]
    async with simulated() as cell:
        await cell.bus.call(PrepareJog(), to="left")
        monkeypatch.setattr(inline_planner, "LOOK_FIXED_S", check_s)
        handle = await cell.begun(JogTool(velocity=DOWN, duration_s=12.0), after_s=0.0)
        ending = asyncio.ensure_future(handle.result())
        heights_m: list[float] = []
        while not ending.done():
            heights_m.append((await cell.tool()).xyz[2])
            await asyncio.wait((ending,), timeout=0.01)
    assert "would touch table" in held_by
    assert ending.result().status is GoalStatus.SUCCEEDED
    assert min(heights_m) > lowest_m - 0.001
    assert heights_m[-1] == pytest.approx(lowest_m, abs=0.006)


@pytest.mark.virtual
@pytest.mark.parametrize("speed", [nightly(0.1), 0.5, 2.0])
@pytest.mark.parametrize("sign", [1.0, -1.0])
async def test_a_joint_stops_before_an_obstacle_at_any_speed(speed: float, sign: float) -> None:
    """Nothing solid: only the scene knows of it."""
    async with simulated() as cell:
        await cell.bus.call(put("post", (0.08, 0.08, 1.0), (-0.33, 0.27 * sign, 0.5)), to="cell")
        velocity = (speed * sign, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0)
        held_by, nearest_m = await jogged(cell, JogJoints(velocity_rad_s=velocity, duration_s=0.6 + 1.2 / speed))
        back = await cell.perform(JogJoints(velocity_rad_s=tuple(-v for v in velocity), duration_s=0.5))
        left = await near(cell)
    assert "would touch post" in held_by
    assert 0.0 < nearest_m < 0.03
    assert back.status is GoalStatus.SUCCEEDED
    assert left.distance_m > nearest_m


@pytest.mark.virtual
async def test_what_comes_into_the_way_of_a_jog_stops_it_and_what_goes_lets_it_go_on() -> None:
    """While the key is down."""
    async with simulated() as cell:
        handle = await cell.begun(JogJoints(velocity_rad_s=ROUND, duration_s=4.0), after_s=0.3)
        await cell.bus.call(put("gate", (0.6, 0.02, 1.0), (-0.4, 0.35, 0.5)), to="cell")
        await cell.until(lambda: cell.speed_rad_s() < 0.02, within_s=2.0)
        stood = cell.joints()
        nearest = await near(cell)
        await cell.bus.call(RemoveObstacle(name="gate"), to="cell")
        end = await handle.result()
        gone = cell.joints()
    assert end.status is GoalStatus.SUCCEEDED
    assert 0.0 < nearest.distance_m < 0.05
    assert gone[0] > stood[0] + 0.5


@pytest.mark.virtual
async def test_what_may_be_touched_and_what_is_not_minded_stops_nothing() -> None:
    """The same way three times: held back, by its name let through, and not looked at."""
    reached: list[float] = []
    for rule in (JogCollisionOptions(), JogCollisionOptions(may_touch=("post",)), JogCollisionOptions(minded=False)):
        async with simulated() as cell:
            await cell.bus.call(put("post", (0.08, 0.08, 1.0), (-0.33, 0.27, 0.5)), to="cell")
            await cell.perform(JogJoints(velocity_rad_s=ROUND, duration_s=1.2, scene=rule))
            reached.append(float(cell.joints()[0]))
    assert reached[0] < reached[1] - 0.3
    assert reached[1] == pytest.approx(reached[2], abs=0.05)


@pytest.mark.virtual
async def test_a_released_key_stops_the_arm_as_soon_as_without_a_scene() -> None:
    """What is passed on anew after a look is no sign of life."""
    rests: list[float] = []
    for rule in (JogCollisionOptions(), JogCollisionOptions(minded=False)):
        async with simulated() as cell:
            await cell.begun(JogTool(idle_s=3.0, watchdog_s=0.2, scene=rule))
            jog = cell.bus.topic("left/jog", JogCommand)
            for _ in range(10):
                jog.publish(JogCommand(velocity=(0.0, 0.0, -0.05, 0.0, 0.0, 0.0)))
                await cell.bus.clock.sleep(0.05)
            assert cell.speed_rad_s() > 0.02
            rests.append(await cell.until(lambda: cell.speed_rad_s() < 0.01, within_s=2.0))
    assert rests[0] < rests[1] + 0.02


@pytest.mark.virtual
@pytest.mark.parametrize(
    "step", [StepTool(step_m=(0.0, 0.0, -0.6), speed_m_s=0.3), StepJoints(step_rad=(0.0, 1.9, 0.0, 0.9, 0.0, 0.0, 0.0))]
)
async def test_a_step_that_would_touch_something_is_rejected_and_nothing_moves(step: StepTool | StepJoints) -> None:
    """With its name."""
    async with simulated() as cell:
        before = cell.joints()
        end = await cell.perform(step)
        moved = np.abs(cell.joints() - before).max()
    assert end.status is GoalStatus.REJECTED
    assert "would touch table" in str(end.cause)
    assert moved < 1e-3


class HoldingTool:
    """A gripper that holds the part `cube`, or nothing."""

    name = "left/gripper"
    grip: GraspCommand | None = None
    moving = False

    def __init__(self) -> None:
        self.part = ""

    def register(self, bus: SkillBus) -> None:
        bus.topic(f"{self.name}/state", GripperState).provide(
            lambda: GripperState(time_s=0.0, width_m=0.03, force_n=20.0, held=bool(self.part), part=self.part)
        )

    async def stop(self) -> None:
        """It rests."""


@pytest.mark.virtual
@pytest.mark.parametrize(
    "step", [StepTool(step_m=(0.0, 0.0, 0.02)), JogTool(velocity=(0, 0, 0.05, 0, 0, 0), duration_s=0.5)]
)
async def test_a_held_part_belongs_to_its_arm_and_never_blocks_it(step: Action[Any, Any]) -> None:
    """A stop between the grasp and its entry in the scene leaves the part there as an obstacle at the fingers."""
    tool = HoldingTool()
    async with fake_cell(tool=tool) as cell:
        at = await cell.bus.call(ForwardKinematics(), to="left")
        await cell.bus.call(put("cube", (0.03, 0.03, 0.03), at.xyz), to="cell")

        async def blocked() -> bool:
            handle = cell.bus.send_goal(step, to="left")
            held: list[str] = []
            handle.on_feedback(lambda feedback: held.append(str(getattr(feedback, "held_by", ""))))
            end = await handle.result()
            return "would touch cube" in f"{end.cause} {held}"

        assert await blocked()
        tool.part = "cube"
        assert not await blocked()
        await cell.bus.call(AttachPart(part="cube", robot="left"), to="cell")
        assert not await blocked()


@pytest.mark.virtual
async def test_a_block_names_both_bodies_their_distance_and_the_ways_that_take_them_apart() -> None:
    """A wall 4 mm beside the hand: away from it leads out, along it does not."""
    async with fake_cell() as cell:
        at = await cell.bus.call(ForwardKinematics(), to="left")
        x, y, z = at.xyz
        await cell.bus.call(put("wall", (0.6, 0.02, 0.6), (x, y + 0.164, z)), to="cell")
        blocks = cell.bus.topic("left/jog_block", JogBlock)
        goal = JogTool(velocity=(0.0, 0.25, 0.0, 0.0, 0.0, 0.0), duration_s=0.4)
        assert (await cell.bus.send_goal(goal, to="left").result()).status is GoalStatus.SUCCEEDED
        block = blocks.latest
        assert block is not None
        assert {block.first.partition("/")[0], block.second} == {"left", "wall"}
        nearest = await cell.bus.call(CheckCollision(robot="left"), to="cell")
        assert block.distance_m == pytest.approx(nearest.distance_m, abs=1e-6)
        directions = {(each.axis, each.sign) for each in block.directions_out}
        assert (1, -1) in directions
        assert directions.isdisjoint({(1, 1), (0, 1), (0, -1), (2, 1), (2, -1)})
        away = JogTool(velocity=(0.0, -0.1, 0.0, 0.0, 0.0, 0.0), duration_s=0.4)
        await cell.bus.send_goal(away, to="left").result()
        assert blocks.latest == JogBlock(robot="left")


@pytest.mark.virtual
async def test_an_arm_in_contact_goes_where_the_block_says_and_nowhere_else() -> None:
    """A bar 3 mm inside of the hand: into it and along it is blocked, and out of it too where a post is."""
    into, along, out = ((0.0, 0.1, 0.0), (0.1, 0.0, 0.0), (0.0, -0.1, 0.0))
    async with fake_cell() as cell:
        x, y, z = (await cell.bus.call(ForwardKinematics(), to="left")).xyz
        await cell.bus.call(put("bar", (0.2, 0.02, 0.04), (x, y + 0.1115, z + 0.08)), to="cell")
        blocks = cell.bus.topic("left/jog_block", JogBlock)

        async def blocked_by(velocity: Vector3) -> str:
            await cell.bus.send_goal(JogTool(velocity=(*velocity, 0.0, 0.0, 0.0), duration_s=0.6), to="left").result()
            block = blocks.latest
            assert block is not None
            return block.second

        assert await blocked_by(into) == "bar"
        block = blocks.latest
        assert block is not None
        assert block.distance_m == 0.0
        assert (1, -1) in {(each.axis, each.sign) for each in block.directions_out}
        assert await blocked_by(along) == "bar"
        assert not await blocked_by(out)
        await cell.bus.call(put("post", (0.2, 0.02, 0.04), (x, y - 0.117, z + 0.08)), to="cell")
        assert await blocked_by(out)


@pytest.mark.virtual
@pytest.mark.parametrize("fails", [False, True])
async def test_a_block_has_no_distance_until_it_is_measured(fails: bool, monkeypatch: pytest.MonkeyPatch) -> None:
    """Both bodies are named at once, and no distance or absence of a direction out is claimed."""
    find = DirectionsOut.find

    async def fail_once(self: DirectionsOut, scene: SceneCheck, pair: NamePair) -> JogBlock:
        monkeypatch.setattr(DirectionsOut, "find", find)
        raise RobotError("the planner is busy", where="left")

    if fails:
        monkeypatch.setattr(DirectionsOut, "find", fail_once)
    async with fake_cell() as cell:
        x, y, z = (await cell.bus.call(ForwardKinematics(), to="left")).xyz
        await cell.bus.call(put("wall", (0.6, 0.02, 0.6), (x, y + 0.164, z)), to="cell")
        told: list[JogBlock] = []
        cell.bus.topic("left/jog_block", JogBlock).subscribe(told.append)
        goal = JogTool(velocity=(0.0, 0.25, 0.0, 0.0, 0.0, 0.0), duration_s=0.4)
        assert (await cell.bus.send_goal(goal, to="left").result()).status is GoalStatus.SUCCEEDED
    first, *_, last = [block for block in told if block.first]
    assert first == JogBlock(robot="left", first=first.first, second="wall")
    assert (last.first, last.second) == (first.first, "wall")
    assert last.distance_m is not None
    assert last.directions_out


@pytest.mark.virtual
async def test_an_arm_is_prepared_for_its_first_jog_and_says_why_it_cannot_be() -> None:
    async with fake_cell() as cell:
        cell.planner.silent_s = 3.0
        ready = await cell.bus.call(PrepareJog(), to="left")
        assert ready.waited_s > 3.0
        cell.planner.failing = "the planning process does not start"
        with pytest.raises(SkillFailed, match="does not start"):
            await cell.bus.call(PrepareJog(), to="left")
        assert cell.cameras.required == 0


async def jog_end(cell: FakeCell, goal: JogJoints) -> tuple[GoalStatus, list[str], set[float]]:
    """Jog to the end; returns how it ended, what held it back, and which speeds of the first joint were sent."""
    handle = cell.bus.send_goal(goal, to="left")
    held: list[str] = []
    handle.on_feedback(lambda feedback: held.append(feedback.held_by))
    end = await handle.result()
    return end.status, held, {round(row[0], 3) for row in sent(cell)}


def sent(cell: FakeCell) -> list[tuple[float, ...]]:
    """What the jog under way was sent."""
    return stream(cell).sent


def stream(cell: FakeCell) -> FakeStream:
    """The jog under way."""
    assert isinstance(cell.port.motion, FakeStream)
    return cell.port.motion


@pytest.mark.virtual
async def test_an_arm_that_nobody_looks_ahead_of_stands() -> None:
    """A planning process that fails, or is silent; cameras that see nothing any more."""
    slow = (0.1, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0)
    async with fake_cell() as cell:
        assert (await jog_end(cell, JogJoints(velocity_rad_s=slow, duration_s=0.5)))[2] == {0.0, 0.1}
        handle = cell.bus.send_goal(JogJoints(velocity_rad_s=slow, duration_s=4.0), to="left")
        held: list[str] = []
        handle.on_feedback(lambda feedback: held.append(feedback.held_by))
        await handle.accepted()
        await cell.bus.clock.sleep(0.3)
        planner, cameras = cell.planner, cell.cameras
        troubles: tuple[tuple[Callable[[bool], None], str], ...] = (
            (lambda on: setattr(planner, "failing", "the process ended" if on else ""), "the process ended"),
            (lambda on: setattr(planner, "silent_s", 9.0 if on else 0.0), "within 0.3 s"),
            (lambda on: cameras.go_blind("no image for 2 s" if on else ""), "no image for 2 s"),
        )
        for trouble, words in troubles:
            trouble(True)
            await cell.bus.clock.sleep(0.4)
            assert words in held[-1]
            assert not any(sent(cell)[-1])
            trouble(False)
            await cell.bus.clock.sleep(0.4)
            assert held[-1] == ""
        await handle.result()
        assert cell.cameras.required == 0


@pytest.mark.virtual
async def test_what_is_passed_on_anew_is_as_old_as_the_word_itself() -> None:
    """So the arm brakes in its time though nobody here is awake to stop it."""
    async with fake_cell() as cell:
        handle = cell.bus.send_goal(JogJoints(watchdog_s=0.2, idle_s=1.0), to="left")
        await handle.accepted()
        began_s = cell.bus.clock.now_s()
        cell.bus.topic("left/jog", JogCommand).publish(JogCommand(velocity=(0.1, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0)))
        ages_s: list[float] = []
        while (now_s := cell.bus.clock.now_s()) < began_s + 0.19:
            if len(stream(cell).ages_s) > len(ages_s):
                ages_s = list(stream(cell).ages_s)
                assert ages_s[-1] > now_s - began_s - 0.002
            await cell.bus.clock.sleep(0.001)
        await handle.result()
    assert len(ages_s) > 3
    assert ages_s[-1] > 0.1


@pytest.mark.virtual
@pytest.mark.parametrize("is_released", [True, False])
async def test_a_press_whose_path_is_checked_in_silence_moves_only_once_it_is_heard(is_released: bool) -> None:
    """A busy machine: the check comes after the watchdog, and so does the release; without it nothing moves."""
    async with fake_cell() as cell:
        clock = cell.bus.clock
        handle = cell.bus.send_goal(JogJoints(watchdog_s=0.12, idle_s=1.0), to="left")
        dropped: list[int] = []
        handle.on_feedback(lambda feedback: dropped.append(feedback.dropped))
        await handle.accepted()
        cell.planner.silent_s = 0.2
        topic = cell.bus.topic("left/jog", JogCommand)
        topic.publish(JogCommand(velocity=(0.1, *STILL[1:]), least_s=0.1))
        await clock.sleep(0.25)
        assert not any(map(any, sent(cell)))
        cell.planner.silent_s = 0.02
        if is_released:
            topic.publish(JogCommand(velocity=STILL))
        await clock.sleep(0.3)
        assert any(map(any, sent(cell))) == is_released
        await handle.result()
    assert dropped[-1] == (not is_released)


@pytest.mark.virtual
async def test_a_jog_is_rejected_where_the_scene_cannot_be_looked_at() -> None:
    """Before anything moves."""
    async with fake_cell() as cell:
        cell.planner.failing = "the planning process does not start"
        end = await cell.bus.send_goal(JogJoints(velocity_rad_s=(0.1,) * 7, duration_s=0.5), to="left").result()
        assert (end.status, "does not start" in str(end.cause)) == (GoalStatus.REJECTED, True)
        assert cell.cameras.required == 0


@pytest.mark.virtual
@pytest.mark.parametrize("seed", [0, *map(nightly, (1, 2))])
async def test_no_jog_in_any_direction_touches_what_stands_around(seed: int) -> None:
    """Three posts at random places around the arm, four jogs of the tool one after the other, fast and askew."""
    random = np.random.default_rng(seed)
    async with simulated() as cell:
        for k in range(3):
            angle, far = random.uniform(0.7, 2.4) * random.choice((-1.0, 1.0)), random.uniform(0.3, 0.6)
            place = (-0.55 + far * np.cos(angle), far * np.sin(angle), random.uniform(0.2, 0.8))
            await cell.bus.call(put(f"post{k}", (0.08, 0.08, 0.5), place), to="cell")
        assert (await near(cell)).distance_m > 0.0
        for _ in range(4):
            twist = np.concatenate((random.normal(size=3) * 0.25, random.normal(size=3) * 0.4))
            _, nearest_m = await jogged(cell, JogTool(velocity=tuple(twist.tolist()), duration_s=1.5))
            assert nearest_m > 0.0
