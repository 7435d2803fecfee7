"""Motions along given paths look where they go: in physics they touch nothing that the scene or the cameras know of."""

from __future__ import annotations

import asyncio
from collections.abc import Callable
from pathlib import Path
from typing import Any

import msgspec
import numpy as np
import pytest

from engine.bus import GoalEnd, GoalStatus
from engine.cause_chain import describe_cause
from engine.messages import FramePoses, Pose
from engine.skill import Action
from engine.skills.arm_control import RecoverFromError
from engine.skills.collision_options import CollisionOptions
from engine.skills.contact import MoveUntilContact
from engine.skills.dmp import CartDMP, JointDMP
from engine.skills.motion import CartLinTask, CartTrapVel, JointTrapVel
from engine.skills.waypoints import FollowWaypoints, Waypoint
from tests.robots.arm.every_skill import cart_dmp, joint_dmp
from tests.robots.panda_arm import panda_kinematics
from tests.robots.workspace.free_cell import (
    ACROSS,
    REST_RAD_S,
    THERE,
    FreeCell,
    Witness,
    box,
    free_cell,
    put_after_the_check,
)
from tests.tiers import nightly

CELL = Path(__file__).parents[1] / "one_panda.yaml"
POST = "  post: {shape: box, size_m: [0.1, 0.1, 0.7], at: {xyz: [-0.05, 0.0, 0.35]}}\n"
"""Between THERE and ACROSS, in the world and in the scene."""
AT_POST = (0.0, *THERE[1:])
"""The tool inside of the post."""
BLIND = CollisionOptions(avoid=False)


def with_post(folder: Path) -> Path:
    """Write the cell of one arm, with a post in its way."""
    file = folder / "cell.yaml"
    file.write_text(CELL.read_text(encoding="utf-8") + POST, encoding="utf-8")
    return file


def tool_at(joints: tuple[float, ...]) -> Pose:
    """Return the pose of the tool at joints, in the world."""
    tool = panda_kinematics().tool_pose(np.array(joints))
    x, y, z = tool.xyz.tolist()
    xyzw = tuple(tool.xyzw.tolist())
    return Pose(xyz=(x, y, z), xyzw=(xyzw[0], xyzw[1], xyzw[2], xyzw[3]))


def _profile() -> Action[Any, Any]:
    return JointTrapVel(joints=ACROSS, speed=0.3)


def _pose_profile() -> Action[Any, Any]:
    return CartTrapVel(pose=tool_at(ACROSS), speed=0.3)


def _line() -> Action[Any, Any]:
    return CartLinTask(pose=tool_at(AT_POST), duration_s=4.0)


def _waypoints() -> Action[Any, Any]:
    return FollowWaypoints(waypoints=(Waypoint(joints=ACROSS),), speed=0.3)


def _joint_primitive() -> Action[Any, Any]:
    return JointDMP(dmp=joint_dmp(np.array(THERE), ACROSS, tau=4.0))


def _cart_primitive() -> Action[Any, Any]:
    start, end = tool_at(THERE), tool_at(AT_POST)
    return CartDMP(
        dmp=cart_dmp(np.array(THERE), y0=(*start.xyz, *start.xyzw), goal=(*end.xyz, *end.xyzw), tau=4.0),
        start_reach_m=0.1,
        start_reach_rad=0.5,
    )


async def end_of(opened: FreeCell, goal: Action[Any, Any]) -> tuple[GoalEnd[Any], str, set[str]]:
    """Carry out a goal; return its end, its cause as a text, and what the arm touched in physics on the way."""
    result = asyncio.ensure_future(opened.bus.send_goal(goal, to="left").result())
    touched: set[str] = set()

    def is_over() -> bool:
        touched.add(opened.touching())
        return result.done()

    await opened.until(is_over, within_s=30.0)
    end = result.result()
    return end, describe_cause(end.cause) if end.cause else "", touched - {""}


async def go(opened: FreeCell, joints: tuple[float, ...]) -> None:
    """Move to joints along a free path."""
    end, why, touched = await end_of(opened, JointTrapVel(joints=joints, speed=0.5))
    assert (end.status, touched) == (GoalStatus.SUCCEEDED, set()), why


@pytest.mark.virtual
@pytest.mark.parametrize(
    "make", [_profile, _line, _waypoints, _cart_primitive, *map(nightly, (_pose_profile, _joint_primitive))]
)
async def test_a_motion_into_something_known_is_refused_with_both_names_and_the_place(
    tmp_path: Path, make: Callable[[], Action[Any, Any]]
) -> None:
    """The same motion that does not look hits it."""
    async with free_cell(tmp_path, cell=with_post(tmp_path)) as opened:
        await go(opened, THERE)
        before = opened.joints()
        end, why, touched = await end_of(opened, make())
        assert (end.status, touched) == (GoalStatus.REJECTED, set()), why
        for words in ("the path is not free", "left/panda_", "would touch post", "of the path", "m from here"):
            assert words in why
        assert np.abs(opened.joints() - before).max() < 1e-3
        _, _, touched = await end_of(opened, msgspec.structs.replace(make(), collisions=BLIND))
        assert any("post" in one for one in touched), touched


@pytest.mark.virtual
async def test_what_may_be_touched_is_pushed_and_an_arm_in_contact_may_leave(tmp_path: Path) -> None:
    async with free_cell(tmp_path, cell=with_post(tmp_path)) as opened:
        await go(opened, THERE)
        line = CartLinTask(pose=tool_at(AT_POST), duration_s=4.0, collisions=CollisionOptions(may_touch=("post",)))
        _, why, touched = await end_of(opened, line)
        assert any("post" in one for one in touched), why
        await opened.bus.call(RecoverFromError(), to="left")
        assert "post" in opened.touching()
        end, why, _ = await end_of(opened, JointTrapVel(joints=THERE, speed=0.5))
        assert (end.status, opened.touching()) == (GoalStatus.SUCCEEDED, ""), why


@pytest.mark.virtual
async def test_a_guarded_move_goes_where_a_line_would_be_refused(tmp_path: Path) -> None:
    """The contact that ends it is what it is for; the same line would press on the table."""
    async with free_cell(tmp_path, cell=CELL) as opened:
        await go(opened, THERE)
        x, y, z = tool_at(THERE).xyz
        below = CartLinTask(pose=Pose(xyz=(x, y, -0.02), xyzw=tool_at(THERE).xyzw), duration_s=4.0)
        end, why, touched = await end_of(opened, below)
        assert (end.status, "would touch table" in why, touched) == (GoalStatus.REJECTED, True, set()), why
        guarded = MoveUntilContact(direction=(0.0, 0.0, -1.0), distance_m=z + 0.02, speed_m_s=0.1)
        end, why, touched = await end_of(opened, guarded)
        assert end.result is not None, why
        assert (end.result.contact, any("table" in one for one in touched)) == (True, True)


@pytest.mark.virtual
async def test_a_guarded_move_is_refused_where_another_link_than_the_tool_would_touch(tmp_path: Path) -> None:
    async with free_cell(tmp_path, cell=CELL) as opened:
        await go(opened, THERE)
        frames = opened.bus.topic("cell/frames", FramePoses).latest
        assert frames is not None
        before = opened.joints()
        elbow = frames.xyz[frames.names.index("left/panda_link4")]
        await opened.put(box("shelf", (0.2, 0.2, 0.02), (elbow[0], elbow[1], elbow[2] - 0.14)))
        end, why, _ = await end_of(opened, MoveUntilContact(direction=(0.0, 0.0, -1.0), distance_m=0.3, speed_m_s=0.1))
        assert (end.status, "would touch shelf" in why, "panda_link" in why) == (GoalStatus.REJECTED, True, True), why
        assert np.abs(opened.joints() - before).max() < 1e-3


SWEEP = JointTrapVel(joints=ACROSS, speed=0.3)
WALL = box("wall", (0.3, 0.02, 1.0), (-0.05, 0.0, 0.5))


@pytest.mark.virtual
@pytest.mark.parametrize("make", [_profile, _waypoints, *map(nightly, (_pose_profile, _joint_primitive))])
async def test_what_gets_into_the_path_of_a_moving_arm_stops_it_in_time_and_ends_the_goal_with_both_names(
    tmp_path: Path, make: Callable[[], Action[Any, Any]]
) -> None:
    async with free_cell(tmp_path, cell=CELL) as opened:
        await go(opened, THERE)
        witness = Witness(opened, WALL)
        handle = opened.bus.send_goal(make(), to="left")
        await opened.until(lambda: opened.speed_rad_s() > 0.2)
        await opened.put(WALL)
        end = await handle.result()
        await witness.end()
        why = describe_cause(end.cause) if end.cause else ""
        assert (end.status, witness.touched, "would touch wall" in why) == (GoalStatus.ABORTED, set(), True), why
        assert opened.speed_rad_s() < REST_RAD_S
        assert opened.joints()[0] > 0.1


@pytest.mark.virtual
async def test_what_gets_into_the_path_between_its_check_and_the_start_is_noticed(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    async with free_cell(tmp_path, cell=CELL) as opened:
        await go(opened, THERE)
        put_after_the_check(opened, WALL, monkeypatch)
        end, why, touched = await end_of(opened, SWEEP)
        assert (end.status, touched, "would touch wall" in why) == (GoalStatus.ABORTED, set(), True), why
        assert opened.joints()[0] > 0.1


@pytest.mark.virtual
async def test_a_patient_motion_waits_before_what_is_in_its_path_and_goes_on_when_it_is_gone(tmp_path: Path) -> None:
    async with free_cell(tmp_path, cell=CELL) as opened:
        await go(opened, THERE)
        patient = msgspec.structs.replace(SWEEP, collisions=CollisionOptions(patience_s=20.0))
        handle = opened.bus.send_goal(patient, to="left")
        await opened.until(lambda: opened.speed_rad_s() > 0.2)
        await opened.put(WALL)
        await opened.until(lambda: opened.speed_rad_s() < REST_RAD_S)
        stood_at = opened.joints()
        await opened.bus.clock.sleep(5.0)
        assert np.abs(opened.joints() - stood_at).max() < 0.01
        await opened.remove("wall")
        end = await handle.result()
        assert end.status is GoalStatus.SUCCEEDED, end.cause
        assert np.abs(opened.joints() - ACROSS).max() < 0.01


@pytest.mark.virtual
async def test_an_arm_that_is_held_before_something_does_not_go_on_into_it(tmp_path: Path) -> None:
    async with free_cell(tmp_path, cell=CELL) as opened:
        await go(opened, THERE)
        witness = Witness(opened, WALL)
        handle = opened.bus.send_goal(SWEEP, to="left")
        await opened.until(lambda: opened.speed_rad_s() > 0.2)
        await handle.hold()
        await opened.put(WALL)
        await opened.bus.clock.sleep(1.0)
        await handle.resume()
        end = await handle.result()
        await witness.end()
        assert (end.status, witness.touched) == (GoalStatus.ABORTED, set())
        assert opened.speed_rad_s() < REST_RAD_S


# Stretched out, each arm reaches beyond the middle between them.
FAR_THERE, FAR_MIDDLE, FAR_ACROSS = ((turn, 0.4, 0.0, -1.9, 0.0, 2.3, 0.8) for turn in (1.0, 0.0, -1.0))


@pytest.mark.virtual
@pytest.mark.parametrize(("collisions", "ends"), [(CollisionOptions(), "stopped"), (BLIND, "touched")])
async def test_an_arm_stops_before_another_one_that_gets_into_its_path(
    tmp_path: Path, collisions: CollisionOptions, ends: str
) -> None:
    """One that does not look touches it."""
    async with free_cell(tmp_path) as opened:
        await go(opened, FAR_THERE)
        right = opened.bus.send_goal(JointTrapVel(joints=FAR_MIDDLE, speed=0.4, collisions=BLIND), to="right")
        await opened.until(lambda: opened.speed_rad_s("right") > 0.2)
        end, why, touched = await end_of(opened, JointTrapVel(joints=FAR_ACROSS, speed=0.15, collisions=collisions))
        await right.result()
        assert (end.status is GoalStatus.SUCCEEDED, bool(touched)) == (False, ends == "touched"), (why, touched)
        if ends == "stopped":
            assert "left/" in why
            assert "would touch right/" in why
            assert opened.speed_rad_s() < REST_RAD_S


@pytest.mark.virtual
@pytest.mark.parametrize("patience_s", [nightly(0.0), 20.0])
async def test_of_two_arms_that_move_towards_one_another_only_the_later_one_stops(
    tmp_path: Path, patience_s: float
) -> None:
    """The first one has reserved its path; a patient later one goes on once it is free."""
    async with free_cell(tmp_path) as opened:
        await go(opened, FAR_THERE)
        first = opened.bus.send_goal(JointTrapVel(joints=FAR_MIDDLE, speed=0.1), to="left")
        await opened.until(lambda: opened.speed_rad_s() > 0.02)
        later = JointTrapVel(joints=FAR_MIDDLE, speed=0.1, collisions=CollisionOptions(patience_s=patience_s))
        second = opened.bus.send_goal(later, to="right")
        touched: set[str] = set()
        await opened.until(lambda: touched.add(opened.touching()) or first.finished, within_s=30.0)
        assert (await first.result()).status is GoalStatus.SUCCEEDED
        if patience_s:
            await opened.until(lambda: opened.speed_rad_s("right") < REST_RAD_S)
            assert not second.finished
            end, why, _ = await end_of(opened, JointTrapVel(joints=FAR_THERE, speed=0.4))
            assert end.status is GoalStatus.SUCCEEDED, why
        end = await second.result()
        why = describe_cause(end.cause) if end.cause else ""
        assert (end.status, touched) == (GoalStatus.SUCCEEDED if patience_s else GoalStatus.ABORTED, {""}), why
        assert patience_s or ("would touch left/" in why and "on its planned path" in why), why
