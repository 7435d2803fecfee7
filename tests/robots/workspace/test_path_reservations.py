"""The ways of arms as a scene has them."""

from __future__ import annotations

from engine.messages import Pose
from engine.messages.shapes import Box, Obstacle, Solid
from robots.planning.scene.exact_checker import ExactChecker
from robots.planning.scene.planning_scene import AttachedPart, PlanningScene, SceneArm
from robots.workspace.path_reservations import describe_names, with_reservations
from tests.robots.panda_arm import home
from tests.robots.sim.sim_cell import LEFT, RIGHT

SCENE = PlanningScene(
    arms=(SceneArm(placement=LEFT), SceneArm(placement=RIGHT)),
    obstacles=(Obstacle.of("table", Box(size_m=(1.0, 1.0, 0.1)), Pose(xyz=(0.0, 0.0, -0.2))),),
    attached=(AttachedPart(name="part", arm="right", solids=(Solid(shape=Box(size_m=(0.1, 0.1, 0.1))),)),),
    allowed=(("left", "right/panda_hand"),),
)
STRETCHED = (0.0, 0.4, 0.0, -1.9, 0.0, 2.3, 0.8)


def test_an_arm_is_also_where_it_will_be_with_what_it_holds_and_what_may_touch_it() -> None:
    scene = with_reservations(SCENE, {"right": (STRETCHED, tuple(home()))})
    assert [arm.name for arm in scene.arms] == ["left", "right", "right~0", "right~1"]
    assert scene.arm("right~0").joints_rad == STRETCHED
    assert [(part.name, part.arm) for part in scene.attached] == [
        ("part", "right"),
        ("part~0", "right~0"),
        ("part~1", "right~1"),
    ]
    assert scene.may_touch("left/panda_link7", "right~1/panda_hand")
    assert not scene.may_touch("left/panda_link7", "right~1/panda_link7")
    assert with_reservations(SCENE, {}) == SCENE


def test_a_claimed_place_is_touched_like_the_arm_itself() -> None:
    ahead = ExactChecker(with_reservations(SCENE, {"right": (STRETCHED,)}), "left")
    there = ExactChecker(SCENE.with_joints("right", STRETCHED), "left")
    joints = home() * 0.0 + STRETCHED
    touched = {(a, b.replace("~0", "")) for a, b in ahead.colliding_pairs(joints) if "~0" in b}
    assert touched == set(there.colliding_pairs(joints)) != set()


def test_claims_are_spoken_of_in_words() -> None:
    assert describe_names("left touches right~12/panda_link7") == "left touches right/panda_link7 on its planned path"
    assert describe_names("table") == "table"
