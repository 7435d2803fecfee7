"""The IRB 4600 carries its plate from pedestal to pedestal in physics, and says honestly when it has none."""

from __future__ import annotations

import math
from pathlib import Path

import pytest

from tests.behaviors.application import Application, causes, changed_cell, shipped_cell, without_parts
from tests.behaviors.stopping import stop_in
from tests.tiers import nightly

BEHAVIOR = "plate_transfer/plate_transfer.yaml"
CELL = "irb4600"
LEFT_M = (1.1, 0.7, 0.704)
REST_RAD_S = 0.02


@pytest.mark.parametrize("seed", [0, *map(nightly, (None, 1, 2, 3, 4))])
def test_the_plate_lies_on_the_left_pedestal_wherever_it_lay_within_its_jitter(
    tmp_path: Path, seed: int | None
) -> None:
    """It hangs at the magnet as far off as it lay, 20 mm in x and y at most, and slips by 2 mm at most."""
    done = Application(behavior=BEHAVIOR, cell=shipped_cell(CELL), seed=seed)
    result = done.run(tmp_path)
    assert (result.outcome, causes(result)) == ("finished", "")
    lay, lies = done.seen[0].parts.poses["plate"].xyz, done.last("plate").xyz
    assert math.hypot(lies[0] - lay[0], lies[1] - lay[1] - 1.4) < 0.002
    assert lies[2] == pytest.approx(LEFT_M[2], abs=0.001)
    assert done.greatest_last_speed_rad_s < REST_RAD_S


def test_between_the_pedestals_the_plate_stays_level_and_on_a_straight_line(tmp_path: Path) -> None:
    """Within 5 mm in x and z, and 1 degree."""
    done = Application(behavior=BEHAVIOR, cell=shipped_cell(CELL))
    assert done.run(tmp_path).outcome == "finished"
    carried = [seen.parts.poses["plate"] for seen in done.seen if abs(seen.parts.poses["plate"].xyz[1]) < 0.6]
    assert len(carried) > 20
    for axis, middle in ((0, 1.1), (2, 0.995)):
        assert all(abs(pose.xyz[axis] - middle) < 0.005 for pose in carried)
    assert max(2 * math.hypot(*pose.xyzw[:2]) for pose in carried) < math.radians(1.0)


@pytest.mark.parametrize(("deeper_m", "ends"), [(0.001, "finished"), (0.0, "missed")])
def test_a_plate_under_the_place_that_was_taught_is_picked_at_the_second_attempt(
    tmp_path: Path, deeper_m: float, ends: str
) -> None:
    """1.5 mm under it, beside the errors of the arm: out of the magnet's reach, and for good if the arm goes as low."""
    taught = changed_cell(CELL, tmp_path, entries=lambda text: text.replace("-0.7, 0.708]", "-0.7, 0.7095]"))
    done = Application(behavior=BEHAVIOR, cell=taught, parameters={"deeper_m": deeper_m})
    result = done.run(tmp_path)
    assert result.outcome == ends
    attempts = [left.rpartition(" ")[2] for left in done.left if left.startswith("root/pick/attract ")]
    assert attempts == ["missed", "held" if deeper_m else "missed"]


def test_a_missing_plate_is_given_up_with_the_magnet_as_the_cause(tmp_path: Path) -> None:
    """After two attempts; the magnet is off and the arm at home."""
    tried = Application(behavior=BEHAVIOR, cell=changed_cell(CELL, tmp_path, cell=without_parts))
    result = tried.run(tmp_path)
    assert result.outcome == "missed"
    assert "the magnet of arm does not hold part plate" in causes(result)
    assert tried.left.count("root/pick/attract missed") == 2
    assert tried.left[-2:] == ["root/home_empty reached", "root missed"]


def test_a_plate_of_aluminium_is_not_picked(tmp_path: Path) -> None:
    cell = changed_cell(CELL, tmp_path, cell=lambda text: text.replace("magnetic: true", "magnetic: false"))
    tried = Application(behavior=BEHAVIOR, cell=cell)
    result = tried.run(tmp_path)
    assert result.outcome == "missed"
    assert "the magnet of arm does not hold part plate" in causes(result)
    assert math.dist(tried.last("plate").xyz, (1.1, -0.7, 0.704)) < 0.002


def test_a_plate_too_heavy_for_the_magnet_stays_on_its_pedestal(tmp_path: Path) -> None:
    """25 kg: it breaks off when the arm goes up, or is not lifted over the gap that an arm beside its model leaves."""
    cell = changed_cell(CELL, tmp_path, cell=lambda text: text.replace("mass_kg: 5.65", "mass_kg: 25.0"))
    tried = Application(behavior=BEHAVIOR, cell=cell, parameters={"attempts": 1})
    result = tried.run(tmp_path)
    assert result.outcome == "missed"
    noticed = ("the magnet of arm lost part plate", "the magnet of arm does not hold part plate")
    assert any(cause in causes(result) for cause in noticed)
    assert tried.last("plate").xyz[1] < -0.6


@pytest.mark.nightly
def test_a_place_that_is_taught_anew_moves_the_plate_there(tmp_path: Path) -> None:
    """14 cm on, which the behavior's own check of the place tells."""
    taught = changed_cell(CELL, tmp_path, entries=lambda text: text.replace("[1.1, 0.7,", "[1.0, 0.6,"))
    done = Application(behavior=BEHAVIOR, cell=taught)
    result = done.run(tmp_path)
    assert math.dist(done.last("plate").xyz, (1.0, 0.6, 0.704)) < 0.003
    assert result.outcome == "failed"
    assert "part plate does not lie at its region" in causes(result)


@pytest.mark.parametrize("path", ["root/preplace", nightly("root/place/down")])
def test_stopped_in_mid_motion_the_arm_rests_and_keeps_the_plate(tmp_path: Path, path: str) -> None:
    stopped = Application(behavior=BEHAVIOR, cell=shipped_cell(CELL), meanwhile=stop_in(path))
    result = stopped.run(tmp_path)
    assert result.status == "stopped"
    assert stopped.greatest_last_speed_rad_s < REST_RAD_S
    assert stopped.last("plate").xyz[2] > 0.71
