"""The planning process answers without holding up the loop, is withdrawn from, survives its own death."""

from __future__ import annotations

import asyncio
import os
import signal
import time

import msgspec
import numpy as np
import pytest

from benchmarks.planning_scenes import ARM, alone, cases
from engine.clock import LoopClock, run_virtual
from engine.errors import CellError, RobotError
from engine.messages import Pose
from engine.messages.sensing import OccupancyGrid
from engine.messages.shapes import Capsule, Obstacle, Solid
from robots.model.mechanics.kinematics import ArmKinematics
from robots.model.registry import robot_model
from robots.model.transform import RigidTransform
from robots.planning.request import (
    AttachedPartCheckRequest,
    CollisionRequest,
    JointGoal,
    PathCheckRequest,
    PathPlan,
    PlanRefusal,
    PlanRequest,
)
from robots.planning.scene.planning_scene import AttachedPart
from robots.planning.worker.inline_planner import LOOK_FIXED_S, InlinePlanner
from robots.planning.worker.plan_service import new_plan_service
from robots.planning.worker.planning_worker import PlanningWorker

SHELF = cases()[-1].request


def never_found() -> PlanRequest:
    """A post that the first link of an arm of two joints cannot pass."""
    origin = RigidTransform.of((0.0, 0.0, 0.0), (0.0, 0.0, 0.0, 1.0))
    tool = ArmKinematics(robot_model("servo_arm"), base=origin).tool_pose(np.array([1.57, 0.0]))
    x, y, z = tool.xyz.tolist()
    post = Obstacle.of("post", Capsule(radius_m=0.02, length_m=0.5), Pose(xyz=(0.3 * x, 0.3 * y, z)))
    return PlanRequest(
        scene=alone("servo_arm").with_obstacles(post),
        arm=ARM,
        start_rad=(0.4, 0.0),
        goal=JointGoal(joints_rad=((2.7, 0.0),)),
        time_s=60.0,
    )


async def test_plans_come_from_another_process_which_dies_and_is_replaced_and_the_loop_stays_free() -> None:
    """One story, because a start of the process takes seconds."""

    async with PlanningWorker() as planner:
        first = planner.pid
        assert first not in (0, os.getpid())
        assert planner.gone == ""
        answer = await planner.plan(msgspec.structs.replace(SHELF, speed=1.0))
        assert isinstance(answer, PathPlan)
        assert answer.timed is not None

        refused = await planner.plan(msgspec.structs.replace(SHELF, planner="EST"))
        assert isinstance(refused, PlanRefusal)
        assert refused.reason == "unknown_planner"
        with pytest.raises(CellError, match="no arm in the planning scene is called left"):
            await planner.plan(msgspec.structs.replace(SHELF, arm="left"))

        # Ways and configurations are looked at there too, with what cameras see.
        block = OccupancyGrid(
            time_s=0.0, revision=1, corner_m=(0.4, -0.3, 0.3), voxel_m=0.1, shape=(2, 4, 2), occupied=b"\xff\xff"
        )
        ways = PathCheckRequest(scene=SHELF.scene, arm=ARM, trajectory=answer.timed, from_s=0.0, occupancy=block)
        check = await planner.check_path(ways)
        assert check.blocked_at_s is not None
        assert {pair[1] for pair in check.pairs} == {"occupancy"}
        assert (await planner.check_path(msgspec.structs.replace(ways, occupancy=None))).blocked_at_s is None
        bar = AttachedPart(name="bar", arm=ARM, solids=(Solid(shape=Capsule(radius_m=0.01, length_m=2.0)),))
        carry = AttachedPartCheckRequest(scene=SHELF.scene.with_attached(bar), arm=ARM, trajectory=answer.timed)
        assert "bar" in (await planner.check_attached_parts(carry)).pairs[0]
        looks = CollisionRequest(scene=SHELF.scene, arm=ARM, joints_rad=SHELF.start_rad, occupancy=block)
        look = await planner.look(looks)
        assert "occupancy" in {pair.second for pair in look.touching}
        with pytest.raises(CellError, match="give 7 joints"):
            await planner.look(msgspec.structs.replace(looks, joints_rad=(0.0,)))

        # A request under way does not hold up the loop, and ends soon after it is withdrawn.
        longest_s = 0.0
        asked = asyncio.ensure_future(planner.plan(never_found()))
        for _ in range(50):
            before = time.thread_time()
            await asyncio.sleep(0.002)
            # Its own work only: how long it had to wait for a processor is not of its making.
            longest_s = max(longest_s, time.thread_time() - before)
        assert not asked.done()
        assert longest_s < 1.0

        # Nor a look at the way of another arm; a request that cannot be is only its own failure.
        assert (await planner.check_path(ways)).blocked_at_s is not None
        with pytest.raises(CellError, match="give 7 joints"):
            await planner.look(msgspec.structs.replace(looks, joints_rad=(0.0,)))
        assert not asked.done()
        asked.cancel()
        with pytest.raises(asyncio.CancelledError):
            await asked
        assert isinstance(await planner.plan(SHELF), PathPlan)
        assert planner.pid == first

        # Several at once are answered in turn.
        answers = await asyncio.gather(*(planner.plan(msgspec.structs.replace(SHELF, seed=k)) for k in range(4)))
        assert all(isinstance(one, PathPlan) for one in answers)

        # Killed while it works: who waits hears of it, the next request finds a new process.
        doomed = asyncio.ensure_future(planner.plan(never_found()))
        await asyncio.sleep(0.1)
        os.kill(first, signal.SIGKILL)
        with pytest.raises(RobotError, match="SIGKILL"):
            await doomed
        assert planner.gone == "the planning process was ended by SIGKILL"
        assert isinstance(await planner.plan(SHELF), PathPlan)
        assert planner.gone == ""
        assert planner.pid not in (0, first)
        last = planner.pid
    assert planner.pid == 0
    with pytest.raises(ProcessLookupError):
        os.kill(last, 0)
    with pytest.raises(RobotError, match="closed"):
        await planner.plan(SHELF)


async def test_a_process_that_hangs_is_ended_and_one_that_still_loads_the_arms_is_not(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr("robots.planning.worker.planning_worker._OVERDUE_S", -0.999)
    looks = CollisionRequest(scene=SHELF.scene, arm=ARM, joints_rad=SHELF.start_rad)
    async with PlanningWorker() as planner:
        assert not (await planner.look(looks)).touching
        monkeypatch.setattr("robots.planning.worker.planning_worker._OVERDUE_S", 0.0)
        frozen = planner.pid
        os.kill(frozen, signal.SIGSTOP)
        with pytest.raises(RobotError, match=r"has not answered within 1\.0 s and was ended"):
            await planner.look(looks)
        assert planner.pid == 0
        assert not (await planner.look(looks)).touching


def test_in_virtual_time_planning_is_inline_takes_the_time_of_its_work_and_repeats() -> None:
    async def scenario() -> list[object]:
        clock = LoopClock()
        service = new_plan_service(clock)
        assert isinstance(service, InlinePlanner)
        found: list[object] = []
        async with service as planner:
            answer = await planner.plan(msgspec.structs.replace(SHELF, speed=1.0))
            assert isinstance(answer, PathPlan)
            found += [answer.waypoints_rad, clock.now_s()]
            assert 0.004 < clock.now_s() < 0.1
            assert answer.timed is not None
            ways = PathCheckRequest(scene=SHELF.scene, arm=ARM, trajectory=answer.timed, from_s=0.0)
            before_s = clock.now_s()
            found.append(await planner.check_path(ways))
            assert clock.now_s() - before_s == pytest.approx(LOOK_FIXED_S)
            found.append(await planner.look(CollisionRequest(scene=SHELF.scene, arm=ARM, joints_rad=SHELF.start_rad)))
            before_s = clock.now_s()
            failed = await planner.plan(msgspec.structs.replace(never_found(), time_s=0.05))
            assert isinstance(failed, PlanRefusal)
            assert failed.reason == "no_path_in_time"
            assert clock.now_s() - before_s > 0.02
            found += [failed, clock.now_s()]
        return found

    assert run_virtual(scenario()) == run_virtual(scenario())


def test_without_a_clock_planning_takes_no_time() -> None:
    async def scenario() -> float:
        clock = LoopClock()
        async with InlinePlanner() as planner:
            assert isinstance(await planner.plan(SHELF), PathPlan)
        return clock.now_s()

    assert run_virtual(scenario()) == 0.0


async def test_a_start_that_takes_too_long_says_so_and_leaves_no_process(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("robots.planning.worker.planning_worker._START_S", 0.0)
    worker = PlanningWorker()
    with pytest.raises(RobotError, match=r"the planner was not ready within 0 s of its start \(try again when"):
        await worker.plan(SHELF)
    assert not worker.pid
    await worker.__aexit__()


async def test_a_start_goes_on_when_who_waits_for_it_is_cancelled_and_ends_with_the_worker() -> None:
    worker = PlanningWorker()
    worker.start()
    await asyncio.sleep(0)
    impatient = asyncio.ensure_future(worker.plan(SHELF))
    await asyncio.sleep(0.05)
    first = worker.pid
    assert first
    impatient.cancel()
    with pytest.raises(asyncio.CancelledError):
        await impatient
    worker.start()
    assert isinstance(await worker.plan(SHELF), PathPlan)
    assert worker.pid == first
    await worker.__aexit__()

    entering = asyncio.ensure_future(PlanningWorker().__aenter__())
    await asyncio.sleep(0.05)
    entering.cancel()
    with pytest.raises(asyncio.CancelledError):
        await entering

    closed = PlanningWorker()
    closed.start()
    await asyncio.sleep(0.02)
    last = closed.pid
    waiting = asyncio.ensure_future(closed.plan(SHELF))
    await asyncio.sleep(0)
    await closed.__aexit__()
    with pytest.raises(RobotError, match="closed"):
        await waiting
    with pytest.raises(ProcessLookupError):
        os.kill(last, 0)
