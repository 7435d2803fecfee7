"""The servo arm rinses the test cylinder in physics and puts it back, notices when it is gone, rests when stopped."""

from __future__ import annotations

import math
from itertools import pairwise
from pathlib import Path

import pytest

from tests.behaviors.application import Application, causes, changed_cell, shipped_cell, without_parts
from tests.behaviors.stopping import stop_in
from tests.tiers import nightly

BEHAVIOR = "test_cylinder/test_cylinder.yaml"
CELL = "servo_arm"
RACK_M = (0.0, 0.225, 0.275)
OUTLET_M = (0.18, 0.135)
REST_RAD_S = 0.02


# As the cylinder leans after this one, the claw met its top where it swung aside with its elbow already lower.
LEANS = 8329704657977214


@pytest.mark.parametrize("seed", [None, LEANS, *map(nightly, (0, 1, 2, 3, 4))])
def test_the_cylinder_is_held_under_the_water_and_stands_in_its_rack_again(tmp_path: Path, seed: int | None) -> None:
    """Three seconds within 5 mm of the outlet's axis; in the end upright, 5 mm from its place at most."""
    done = Application(behavior=BEHAVIOR, cell=shipped_cell(CELL), seed=seed)
    result = done.run(tmp_path)
    assert (result.outcome, causes(result)) == ("finished", "")
    rinsed_s = sum(
        after.time_s - before.time_s
        for before, after in pairwise(done.seen)
        if math.dist(before.parts.poses["test_cylinder"].xyz[:2], OUTLET_M) < 0.005
    )
    assert rinsed_s >= 3.0
    last = done.last("test_cylinder")
    assert math.dist(last.xyz, RACK_M) < 0.005
    assert 2 * math.hypot(*last.xyzw[:2]) < math.radians(5.0)
    assert done.greatest_last_speed_rad_s < REST_RAD_S


def test_a_missing_cylinder_is_given_up_with_the_gripper_as_the_cause(tmp_path: Path) -> None:
    """After two attempts, with the arm at home."""
    tried = Application(behavior=BEHAVIOR, cell=changed_cell(CELL, tmp_path, cell=without_parts))
    result = tried.run(tmp_path)
    assert result.outcome == "missed"
    assert "arm did not grasp part test_cylinder" in causes(result)
    assert "touch nothing" in causes(result)
    assert tried.left.count("root/pick/grip missed") == 2
    assert tried.left[-2:] == ["root/home_empty reached", "root missed"]


def test_the_outlet_that_is_taught_anew_is_where_the_cylinder_is_rinsed(tmp_path: Path) -> None:
    """A position is enough: the two joints leave no choice of the orientation."""
    taught = changed_cell(
        CELL, tmp_path, entries=lambda text: text.replace("[0.18, 0.135, 0.275]", "[0.135, 0.18, 0.275]")
    )
    done = Application(behavior=BEHAVIOR, cell=taught)
    result = done.run(tmp_path)
    assert result.outcome == "missed"
    assert "part test_cylinder does not lie at its region" in causes(result)
    nearest = min(math.dist(seen.parts.poses["test_cylinder"].xyz[:2], (0.135, 0.18)) for seen in done.seen)
    assert nearest < 0.005


def test_a_position_off_the_arm_s_sphere_is_refused_with_the_distance(tmp_path: Path) -> None:
    taught = changed_cell(CELL, tmp_path, entries=lambda text: text.replace("[0, 0.225, 0.275]", "[0, 0.3, 0.275]"))
    result = Application(behavior=BEHAVIOR, cell=taught).run(tmp_path)
    assert result.outcome == "failed"
    assert "arm did not reach pose entry cylinder" in causes(result)
    assert "0.075 m" in causes(result)


@pytest.mark.parametrize("path", ["root/water/over", nightly("root/place/down")])
def test_stopped_in_mid_motion_the_arm_rests_and_keeps_the_cylinder(tmp_path: Path, path: str) -> None:
    stopped = Application(behavior=BEHAVIOR, cell=shipped_cell(CELL), meanwhile=stop_in(path))
    result = stopped.run(tmp_path)
    assert result.status == "stopped"
    assert stopped.greatest_last_speed_rad_s < REST_RAD_S
    assert stopped.last("test_cylinder").xyz[2] > 0.28
