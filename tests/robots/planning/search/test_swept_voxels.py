"""The unknown space on a trajectory: found where the arm goes, not where it is or where it does not go."""

from __future__ import annotations

import numpy as np
import pytest

from benchmarks.planning_scenes import ARM, alone
from engine.errors import CellError
from engine.messages import Pose, Vector3
from engine.messages.sensing import NEVER_SEEN, ObservedSpace
from engine.messages.shapes import Box, Solid
from robots.planning.scene.exact_checker import ExactChecker
from robots.planning.scene.planning_scene import AttachedPart, PlanningScene
from robots.planning.swept_space import CoverRegion, SweptSpace, SweptSpaceRequest
from robots.planning.worker.scene_planner import ScenePlanner
from robots.port import Array, JointTrajectory

PLANNER = ScenePlanner(check_s=2e-5)
PANDA = alone("panda")
HOME = np.array(ExactChecker(PANDA, ARM).model.home_rad)
CORNER, VOXEL, SHAPE = (-1.0, -1.0, -0.2), 0.04, (50, 50, 40)


def line(end: Array, *, rows: int = 101) -> JointTrajectory:
    """Return a straight line of joints from home, 2 s."""
    share = np.linspace(0.0, 1.0, rows)[:, None]
    return JointTrajectory(
        dt_s=2.0 / (rows - 1), position_rad=HOME + share * (end - HOME), velocity_rad_s=np.zeros((rows, len(HOME)))
    )


def turn(by: float, *, rows: int = 101) -> JointTrajectory:
    """Return a turn of the first joint."""
    end = HOME.copy()
    end[0] += by
    return line(end, rows=rows)


def space(*unknown: tuple[Vector3, Vector3], age: int = NEVER_SEEN) -> ObservedSpace:
    """Return seen space but for boxes, each from its lowest to its highest corner."""
    ages = np.zeros(SHAPE, dtype=np.uint8)
    for low, high in unknown:
        first, last = (((np.array(each) - CORNER) / VOXEL).round().astype(int) for each in (low, high))
        ages[first[0] : last[0], first[1] : last[1], first[2] : last[2]] = age
    return ObservedSpace(time_s=0.0, corner_m=CORNER, voxel_m=VOXEL, shape=SHAPE, limit_s=5.0, ages=ages.tobytes())


def swept(
    observed: ObservedSpace,
    trajectory: JointTrajectory,
    *regions: CoverRegion,
    scene: PlanningScene = PANDA,
) -> SweptSpace:
    """Return the unknown space that the arm passes through."""
    return PLANNER.swept_space(
        SweptSpaceRequest(scene=scene, arm=ARM, trajectory=trajectory, observed=observed, regions=regions)
    )


EVERYWHERE = ((-1.0, -1.0, -0.2), (1.0, 1.0, 1.4))
LEFT = ((-0.4, 0.2, 0.2), (0.4, 0.8, 0.8))
RIGHT = ((-0.4, -0.8, 0.2), (0.4, -0.4, 0.8))


def test_seen_space_and_unknown_space_beside_the_path_are_no_reason() -> None:
    assert swept(space(), turn(1.5)).unknown_m3 == 0.0
    assert swept(space(RIGHT), turn(1.5)).unknown_m3 == 0.0


def test_unknown_space_on_the_path_is_found_with_its_place_and_time() -> None:
    result = swept(space(LEFT), turn(1.5))
    assert result.unknown_m3 > 0.003
    assert 0.3 < result.at_s < 2.0
    assert all(low <= value <= high for low, value, high in zip(LEFT[0], result.first_m, LEFT[1], strict=True))
    inside = zip(LEFT[0], result.low_m, result.high_m, LEFT[1], strict=True)
    assert all(a - 1e-9 <= b < c <= d + 1e-9 for a, b, c, d in inside)
    assert result.age_s is None


def test_the_age_decides_and_is_reported() -> None:
    assert swept(space(LEFT, age=50), turn(1.5)).unknown_m3 == 0.0
    assert swept(space(LEFT, age=73), turn(1.5)).age_s == pytest.approx(7.3)


def test_space_that_the_arm_takes_up_at_the_start_is_known() -> None:
    still = swept(space(EVERYWHERE), turn(0.0))
    assert still.unknown_m3 == 0.0
    assert swept(space(EVERYWHERE), turn(1.5)).unknown_m3 > 0.03


def test_few_rows_sweep_the_same_space_as_many() -> None:
    many, few = (swept(space(EVERYWHERE), turn(1.5, rows=rows)).unknown_m3 for rows in (1001, 3))
    assert few == pytest.approx(many, rel=0.1)


def test_an_attached_part_sweeps_space_too() -> None:
    long = AttachedPart(
        name="rod", arm=ARM, solids=(Solid(shape=Box(size_m=(0.04, 0.04, 0.6)), pose=Pose(xyz=(0, 0, 0.3))),)
    )
    bare, held = (swept(space(EVERYWHERE), turn(1.5), scene=scene) for scene in (PANDA, PANDA.with_attached(long)))
    assert held.unknown_m3 > bare.unknown_m3 + 0.005


def test_only_regions_count_where_there_are_any() -> None:
    left = CoverRegion(name="left", center_m=(0.0, 0.6, 0.5), size_m=(0.8, 0.8, 0.8))
    right = CoverRegion(name="right", center_m=(0.0, -0.7, 0.5), size_m=(0.8, 0.6, 0.8))
    everything = space(EVERYWHERE)
    assert swept(everything, turn(1.5), right).unknown_m3 == 0.0
    assert swept(everything, turn(1.5), left, right).regions == ("left",)


def test_a_message_that_does_not_fit_itself_is_refused() -> None:
    broken = ObservedSpace(time_s=0.0, corner_m=CORNER, voxel_m=VOXEL, shape=SHAPE, limit_s=5.0, ages=b"\0")
    with pytest.raises(CellError, match="1 bytes are not the ages"):
        swept(broken, turn(0.1))
