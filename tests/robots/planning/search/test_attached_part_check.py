"""What an arm holds is looked at along a whole way: contact as it began, or at its end, is no collision."""

from __future__ import annotations

import msgspec
import numpy as np
import pytest

from benchmarks.planning_scenes import ARM, alone, box
from engine.errors import CellError
from engine.messages import Pose
from engine.messages.shapes import Box, Obstacle, Solid
from engine.skills.planning_scene import CONTACT_M
from robots.planning.request import AttachedPartCheckRequest, PathCheck
from robots.planning.scene.exact_checker import ExactChecker
from robots.planning.scene.planning_scene import AttachedPart, PlanningScene, SceneArm
from robots.planning.worker.scene_planner import ScenePlanner
from robots.port import Array, JointTrajectory
from robots.scene.sim_scene import ArmPlacement
from tests.robots.planning.search.test_path_check import HOME, line, turned

ROD = AttachedPart(
    name="rod", arm=ARM, solids=(Solid(shape=Box(size_m=(0.6, 0.02, 0.02)), pose=Pose(xyz=(0.3, 0.0, 0.12))),)
)
SCENE = alone("panda").with_attached(ROD)
TURN = line(turned(6, -0.6), turned(6, 0.6))
"""The hand turns and the tip of the rod sweeps round; the tool centre stays where it is."""


def check(way: JointTrajectory, *obstacles: Obstacle, scene: PlanningScene = SCENE) -> PathCheck:
    return ScenePlanner().check_attached_parts(
        AttachedPartCheckRequest(scene=scene.with_obstacles(*obstacles), arm=ARM, trajectory=way)
    )


def tip(joints: Array) -> Array:
    """Where the outer end of the rod is, at `joints` (n,), in the world."""
    corners = ExactChecker(SCENE, ARM).held_points(joints)
    away = np.linalg.norm(corners - _hand(joints), axis=1)
    return corners[np.argsort(away)[-4:]].mean(axis=0)


def _hand(joints: Array) -> Array:
    stub = msgspec.structs.replace(ROD, solids=(Solid(shape=Box(size_m=(0.01, 0.01, 0.01))),))
    return ExactChecker(alone("panda").with_attached(stub), ARM).held_points(joints).mean(axis=0)


def post(at: Array, *, size_m: float = 0.02) -> Obstacle:
    x, y, z = at.tolist()
    return box("post", (size_m, size_m, size_m), (x, y, z))


def test_a_part_sweeps_into_something_although_the_tool_only_turns() -> None:
    found = check(TURN, post(tip(HOME)))
    assert found.pairs == (("rod", "post"),)
    assert found.blocked_at_s == pytest.approx(1.0, abs=0.1)
    assert check(TURN).blocked_at_s is None


def test_something_thin_is_not_passed_between_two_looks() -> None:
    assert check(TURN, post(tip(HOME), size_m=0.003)).pairs == (("rod", "post"),)


def test_what_the_scene_allows_may_be_touched_and_the_arm_itself_is_not_looked_at() -> None:
    allowed = SCENE.with_obstacles(post(tip(HOME))).with_allowed("rod", "post")
    assert check(TURN, scene=allowed).blocked_at_s is None
    x, y, z = _hand(HOME).tolist()
    assert check(TURN, box("hand", (0.05, 0.05, 0.05), (x, y, z))).blocked_at_s is None


@pytest.mark.parametrize(("beyond_m", "free"), [(0.0, True), (CONTACT_M - 0.002, True), (CONTACT_M + 0.002, False)])
def test_contact_at_the_end_is_as_deep_as_it_may_be(beyond_m: float, free: bool) -> None:
    """A small wall that the side of the tip, 1 cm from its middle, reaches at the end or before it."""
    end = turned(6, 0.6)
    along = tip(end) - tip(end - np.array([0.0] * 6 + [1e-3]))
    along /= np.linalg.norm(along)
    wall = Obstacle.of("wall", Box(size_m=(0.004, 0.004, 0.004)), _placed(tip(end) + along * (0.012 - beyond_m), along))
    assert (check(TURN, wall).blocked_at_s is None) == free


def _placed(at: Array, along: Array) -> Pose:
    """A box at a place, with its x axis along a direction in the plane."""
    x, y, z = at.tolist()
    half = float(np.arctan2(along[1], along[0])) / 2
    return Pose(xyz=(x, y, z), xyzw=(0.0, 0.0, float(np.sin(half)), float(np.cos(half))))


def test_what_is_touched_at_the_start_may_be_left_and_passed_along_but_not_gone_into() -> None:
    """The rod begins below a post and half a millimetre in it."""
    over = post(tip(HOME) + np.array([0.0, 0.0, 0.0195]))
    down, aside, up = (check(line(HOME, end), over) for end in (turned(5, -0.3), turned(6, 0.6), turned(5, 0.3)))
    assert (down.blocked_at_s, aside.blocked_at_s, up.pairs) == (None, None, (("rod", "post"),))


def test_an_arm_in_the_way_is_named_with_its_link() -> None:
    x, y, z = tip(turned(6, 0.6)).tolist()
    other = SceneArm(placement=ArmPlacement(name="other", model="panda", base=Pose(xyz=(x, y, z - 0.1))))
    found = check(TURN, scene=msgspec.structs.replace(SCENE, arms=(*SCENE.arms, other)))
    assert found.pairs == (("rod", "other/panda_link1"),)


def test_a_way_of_another_arm_is_refused() -> None:
    short = line(HOME[:2], HOME[:2] + 0.1)
    with pytest.raises(CellError, match="a path of 2 joints does not fit this arm"):
        check(short)


def test_an_arm_that_stands_still_is_free() -> None:
    assert check(line(HOME, HOME)) == PathCheck(blocked_at_s=None, pairs=(), looked_s=2.0)
