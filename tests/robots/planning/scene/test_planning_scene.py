"""The scene is data that never changes: what is added, taken away, held and allowed."""

from __future__ import annotations

from collections.abc import Callable

import msgspec
import numpy as np
import pytest

from benchmarks.planning_scenes import ARM, alone, box
from engine.errors import CellError
from engine.messages import Pose
from engine.messages.shapes import Hull, Obstacle, Solid, Sphere
from robots.model.registry import robot_model
from robots.planning.scene.cell_planning_scene import planning_scene
from robots.planning.scene.exact_checker import ExactChecker
from robots.planning.scene.planning_scene import AttachedPart, PlanningScene
from robots.scene.sim_scene import ArmPlacement, FixtureBody, PartBody, SimScene

BOX = box("box", (0.1, 0.1, 0.1), (0.5, 0.0, 0.3))
CUP = AttachedPart(name="cup", arm=ARM, solids=(Solid(shape=Sphere(radius_m=0.03)),))


def test_a_scene_with_something_more_leaves_the_old_one_as_it_was() -> None:
    empty = alone("panda")
    assert empty.with_obstacles(BOX).obstacles == (BOX,)
    assert empty.obstacles == ()


def test_an_obstacle_takes_the_place_of_one_of_its_name() -> None:
    moved = box("box", (0.1, 0.1, 0.1), (0.0, 0.5, 0.3))
    assert alone("panda").with_obstacles(BOX).with_obstacles(moved).obstacles == (moved,)


def test_what_is_taken_into_the_hand_is_no_longer_an_obstacle() -> None:
    scene = alone("panda").with_obstacles(Obstacle.of("cup", Sphere(radius_m=0.03), Pose(xyz=(0.4, 0.0, 0.1))))
    held = scene.with_attached(CUP)
    assert held.obstacles == ()
    assert held.attached == (CUP,)


def test_allowed_pairs_have_no_order_and_a_name_of_an_arm_stands_for_its_links() -> None:
    scene = alone("panda").with_allowed("box", f"{ARM}/panda_hand").with_allowed("table", ARM)
    assert scene.may_touch(f"{ARM}/panda_hand", "box")
    assert not scene.may_touch(f"{ARM}/panda_link7", "box")
    assert scene.may_touch("table", f"{ARM}/panda_link1")


FLAT = Hull(points_m=((0, 0, 0), (1, 0, 0), (0, 1, 0), (1, 1, 0)))


def changes(scene: PlanningScene) -> list[tuple[Callable[[], object], str]]:
    """Return what cannot be done, and a word of the refusal."""
    return [
        (lambda: scene.arm("left"), "no arm"),
        (lambda: scene.with_attached(CUP).with_attached(CUP), "already in the scene"),
        (lambda: scene.with_attached(CUP).with_obstacles(box("cup", (1, 1, 1), (0, 0, 0))), "already in the scene"),
        (lambda: ExactChecker(scene.with_obstacles(box("flat", (1.0, 1.0, 0.0), (0, 0, 0))), ARM), "positive"),
        (lambda: ExactChecker(scene.with_obstacles(Obstacle.of("f", FLAT, BOX.pose)), ARM), "thickness"),
        (lambda: ExactChecker(scene.with_attached(msgspec.structs.replace(CUP, link="elbow")), ARM), "no link elbow"),
        (lambda: ExactChecker(scene.with_joints(ARM, [0.0]), "other"), "no arm"),
    ]


@pytest.mark.parametrize("index", range(7))
def test_what_cannot_be_is_refused_by_name(index: int) -> None:
    change, message = changes(alone("panda").with_obstacles(BOX))[index]
    with pytest.raises(CellError, match=message):
        change()


def test_a_scene_crosses_a_process_border_unchanged() -> None:
    scene = alone("ur10").with_obstacles(BOX).with_attached(CUP).with_allowed("box", "cup").with_joints(ARM, [0.1] * 6)
    assert msgspec.msgpack.decode(msgspec.msgpack.encode(scene), type=PlanningScene) == scene


def test_the_scene_of_a_cell_has_its_fixtures_and_parts_and_may_touch_what_the_arm_stands_on() -> None:
    cell = SimScene(
        arms=(ArmPlacement(name="left", model="panda", base=Pose(xyz=(0.0, 0.0, 0.0))),),
        fixtures=(
            FixtureBody(name="table", shape="box", size_m=(1.0, 1.0, 0.04), pose=Pose(xyz=(0.0, 0.0, -0.02))),
            FixtureBody(name="tray", shape="tray", size_m=(0.3, 0.2, 0.05), pose=Pose(xyz=(0.5, 0.0, 0.0))),
        ),
        parts=(PartBody(name="peg", shape="cylinder", size_m=(0.04, 0.1), mass_kg=0.1, pose=BOX.pose),),
    )
    scene = planning_scene(cell, parts={"peg": Pose(xyz=(0.5, 0.0, 0.1))})
    assert [(o.name, len(o.solids)) for o in scene.obstacles] == [("table", 1), ("tray", 5), ("peg", 1)]
    assert scene.obstacles[2].pose == Pose(xyz=(0.5, 0.0, 0.1))
    assert scene.allowed == (("left/panda_link1", "table"),)
    home = robot_model("panda").home_rad
    assert ExactChecker(scene, "left").colliding_pairs(np.array(home)) == ()


def test_a_shape_that_there_is_not_is_refused() -> None:
    fixture = FixtureBody(name="cone", shape="cone", size_m=(1.0, 1.0), pose=Pose(xyz=(0.0, 0.0, 0.0)))
    with pytest.raises(CellError, match="does not fit a cone"):
        planning_scene(SimScene(fixtures=(fixture,)))
