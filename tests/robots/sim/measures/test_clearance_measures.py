"""How near an arm, its tool and what it holds come to what they must not touch, where geometry tells it beforehand."""

from __future__ import annotations

import math

import msgspec
import numpy as np
import pytest

from engine.messages import Pose, Vector3
from robots.port import Array
from robots.scene.sim_scene import FixtureBody, SimScene
from robots.sim.commands.world_commands import MoveTool, RestoreWorld
from robots.sim.measures.clearance_measures import LIMIT_M
from robots.sim.measures.passing_distance import PassingDistance
from robots.sim.physics.cell_model import CellModel, build_cell
from tests.robots.sim.sim_cell import ABOVE_PART, AT_PART, LEFT, LIFTED, PART_XYZ, RIGHT, TABLE, box, one_arm
from tests.robots.sim.stepped import SteppedArm

FIRST_JOINT = np.eye(7)[0]
# The tips of the fingers are below the tool centre point, and the elbow of an arm at home is above its table.
TIP_M, HOME_M = 0.0094, 0.243
CLOSE, NARROW, OPEN = (0.0, 0.1, 20.0), (0.04, 0.1, 20.0), (0.08, 0.1, 20.0)
"""Opening, speed and force of the fingers; the part is 30 mm wide."""


def clearance(arm: SteppedArm, name: str = "left") -> float:
    """Return the clearance that its world has summed up."""
    kept = arm.simulation.measures
    return kept.layout.read(kept.values())[f"{name}.clearance_min_m"]


def contacts(arm: SteppedArm) -> float:
    """Return how many contacts its world has counted."""
    kept = arm.simulation.measures
    return kept.layout.read(kept.values())["cell.contacts"]


def on_the_arc(angle_rad: float, z_m: float) -> Vector3:
    """Return a point below the arc on which the first joint moves the tool from above the part."""
    x, y = PART_XYZ[0] - LEFT.base.xyz[0], PART_XYZ[1]
    radius_m, start_rad = math.hypot(x, y), math.atan2(y, x)
    angle_rad += start_rad
    return (LEFT.base.xyz[0] + radius_m * math.cos(angle_rad), radius_m * math.sin(angle_rad), z_m)


def with_fixture(scene: SimScene, fixture: FixtureBody) -> CellModel:
    """Return a built scene with one fixture more."""
    return build_cell(msgspec.structs.replace(scene, fixtures=(TABLE, fixture)))


def post(height_m: float, angle_rad: float) -> FixtureBody:
    """Return a post of 30 x 30 mm that stands below the arc."""
    pose = Pose(xyz=on_the_arc(angle_rad, height_m / 2))
    return FixtureBody(name="post", shape="box", size_m=(0.03, 0.03, height_m), pose=pose)


def at(cell: CellModel, joints_rad: Array, tool: tuple[float, float, float] = OPEN) -> SteppedArm:
    """Return an arm at rest there with its fingers like that, with everything summed up from now on."""
    arm = SteppedArm(cell)
    move_tool(arm, tool)
    arm.follow(joints_rad, 1.2)
    arm.until_finished()
    image = np.zeros(arm.simulation.image_layout.size)
    arm.simulation.write_image(image)
    arm.apply(RestoreWorld(image=image))
    return arm


def move_tool(arm: SteppedArm, goal: tuple[float, float, float], *, motion: int = 9) -> None:
    """Open or close the fingers."""
    arm.apply(MoveTool(arm="left", motion=motion, goal=goal))
    arm.until_finished(motion)


def go(arm: SteppedArm, goal: Array, duration_s: float, *, motion: int) -> None:
    """Go there."""
    arm.follow(goal, duration_s, motion=motion)
    arm.until_finished(motion)


@pytest.fixture(scope="module", name="cell")
def _cell() -> CellModel:
    return build_cell(one_arm(box("part")))


def test_an_arm_at_rest_is_as_near_as_its_nearest_link(cell: CellModel) -> None:
    """The second link turns in place above the table; the base stands on it, which is no clearance."""
    arm = SteppedArm(cell)
    arm.run(0.1)
    assert clearance(arm) == pytest.approx(HOME_M, abs=1e-3)
    assert clearance(arm, "cell") == clearance(arm)


@pytest.mark.parametrize("duration_s", [1.0, 4.0])
def test_a_tool_that_passes_a_ball_is_as_near_as_at_the_nearest_point(duration_s: float) -> None:
    """However fast it passes: at most with 1 m/s here, and 3 mm above a ball of 20 mm."""
    ball = FixtureBody(
        name="ball", shape="sphere", size_m=(0.02,), pose=Pose(xyz=on_the_arc(0.5, 0.15 - TIP_M - 0.003 - 0.01))
    )
    arm = at(with_fixture(one_arm(), ball), ABOVE_PART, CLOSE)
    arm.run(0.1)
    assert clearance(arm) > 0.1
    go(arm, ABOVE_PART + 1.0 * FIRST_JOINT, duration_s, motion=2)
    assert clearance(arm) == pytest.approx(0.003, abs=0.0005)
    assert contacts(arm) == 0.0


def test_a_touch_is_no_clearance() -> None:
    """However short it is; it is a contact, too."""
    arm = at(with_fixture(one_arm(), post(0.17, 0.3)), ABOVE_PART)
    arm.follow(ABOVE_PART + 0.3 * FIRST_JOINT, 1.0, motion=2)
    arm.run(1.0)
    assert contacts(arm) >= 1.0
    assert -0.01 < clearance(arm) <= 0.0


def test_a_part_that_is_taken_and_set_down_is_no_obstacle(cell: CellModel) -> None:
    """Nor is the table to the part: what is left is how near the tips of the fingers are to the table."""
    arm = at(cell, ABOVE_PART)
    go(arm, AT_PART, 0.8, motion=2)
    move_tool(arm, CLOSE, motion=10)
    go(arm, LIFTED, 0.8, motion=3)
    go(arm, AT_PART, 0.8, motion=4)
    move_tool(arm, OPEN, motion=11)
    go(arm, ABOVE_PART, 0.8, motion=5)
    assert clearance(arm) == pytest.approx(0.022 - TIP_M, abs=1e-3)


def test_fingers_that_pass_a_part_have_a_clearance(cell: CellModel) -> None:
    """They come down around it and leave again without taking it, each at most 5 mm beside it."""
    arm = at(cell, ABOVE_PART, NARROW)
    go(arm, AT_PART, 0.8, motion=2)
    go(arm, ABOVE_PART, 0.8, motion=3)
    assert 0.003 < clearance(arm) < 0.006
    assert contacts(arm) == 0.0


def test_a_held_part_that_passes_a_post_has_the_clearance_of_its_arm() -> None:
    """It is lower than the fingers, and 5 mm above the post; the fingers came only within 12 mm of the table."""
    lifted_m = 0.1777
    arm = at(with_fixture(one_arm(box("part")), post(lifted_m - 0.005, 0.3)), ABOVE_PART)
    go(arm, AT_PART, 0.8, motion=2)
    move_tool(arm, CLOSE, motion=10)
    go(arm, LIFTED, 0.8, motion=3)
    assert clearance(arm) == pytest.approx(0.022 - TIP_M, abs=1e-3)
    go(arm, LIFTED + 0.6 * FIRST_JOINT, 1.0, motion=4)
    # Nor does it count as set down when the fingers open above the other side of the table.
    move_tool(arm, OPEN, motion=11)
    arm.run(0.2)
    assert clearance(arm) == pytest.approx(0.005, abs=0.001)


def test_a_part_that_is_held_in_a_restored_world_is_no_contact(cell: CellModel) -> None:
    """It was taken before: neither a contact nor an obstacle."""
    arm = at(cell, ABOVE_PART)
    go(arm, AT_PART, 0.8, motion=2)
    move_tool(arm, CLOSE, motion=10)
    image = np.zeros(arm.simulation.image_layout.size)
    arm.simulation.write_image(image)
    arm.apply(RestoreWorld(image=image))
    arm.run(0.1)
    assert contacts(arm) == 0.0
    assert clearance(arm) == pytest.approx(0.022 - TIP_M, abs=1e-3)


def test_two_arms_share_the_distance_between_them() -> None:
    """It is the clearance of both, and of the cell; without a table and with the limit it is all there is."""
    scene = msgspec.structs.replace(one_arm(), arms=(LEFT, RIGHT), fixtures=())
    arm = SteppedArm(build_cell(scene))
    arm.follow(np.array([0.0, 0.4, 0.0, -1.9, 0.0, 2.2, 0.8]), 1.5)
    arm.until_finished()
    assert clearance(arm) < 0.4
    assert clearance(arm, "right") == clearance(arm) == clearance(arm, "cell")


def test_an_arm_alone_has_no_clearance() -> None:
    """And one that is far from everything has the distance that does not matter any more."""
    arm = SteppedArm(build_cell(msgspec.structs.replace(one_arm(), fixtures=())))
    arm.run(0.1)
    kept = arm.simulation.measures
    assert not any("clearance" in name for name in kept.layout.read(kept.values()))
    far = FixtureBody(name="far", shape="sphere", size_m=(0.02,), pose=Pose(xyz=(3.0, 0.0, 0.0)))
    arm = SteppedArm(build_cell(msgspec.structs.replace(one_arm(), fixtures=(far,))))
    arm.run(0.1)
    assert clearance(arm) == LIMIT_M


def passed(*distances_m: float) -> list[float]:
    """Return the distances at which two things passed each other."""
    passing = PassingDistance()
    return [passed_m for each in distances_m if (passed_m := passing.follow(each)) < math.inf]


def test_only_a_least_distance_between_two_larger_ones_is_passed() -> None:
    """Not the beginning at a distance of nothing, not the end, and not a tremor."""
    assert passed(0.0, 0.1, 0.2) == []
    assert passed(0.2, 0.1, 0.0) == []
    assert passed(0.3, 0.1, 0.02, 0.021, 0.05, 0.3, 0.29, 0.3) == [0.02]
    assert passed(0.0, 0.1, 0.05, 0.03, 0.09, 0.04, 0.06) == [0.03, 0.04]
