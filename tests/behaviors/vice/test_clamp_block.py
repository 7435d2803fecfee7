"""A slide brings a block, a vice without sensors clamps it; each failure is an outcome with its cause."""

from __future__ import annotations

from pathlib import Path

import pytest

from engine.document.faults import load_faults
from tests.behaviors.application import BEHAVIORS, Application, causes, shipped_cell
from tests.tiers import nightly

BEHAVIOR = "vice/clamp_block.yaml"


def with_fault(name: str) -> Application:
    """Return the application with a fault file that ships with it."""
    faults = load_faults(BEHAVIORS / "vice" / "faults" / f"{name}.yaml")
    return Application(behavior=BEHAVIOR, cell=shipped_cell("vice"), seed=1, faults=faults)


@pytest.mark.parametrize("seed", [1, *map(nightly, range(2, 21))])
def test_the_arm_cannot_take_the_block_out_of_the_vice(tmp_path: Path, seed: int) -> None:
    """It pulls with what its fingers hold, below what the jaws hold: the block stays at the fixed jaw, on the bed."""
    done = Application(behavior=BEHAVIOR, cell=shipped_cell("vice"), seed=seed)
    result = done.run(tmp_path)
    assert (result.outcome, causes(result)) == ("clamped", "")
    assert {"root/bring reached", "root/close timed", "root/pull missed"} <= set(done.left)
    x, y, z = done.last("block").xyz
    assert x == pytest.approx(0.505, abs=0.002)
    assert y == pytest.approx(0.3, abs=0.0015)
    assert z == pytest.approx(0.15, abs=0.002)


def test_a_vice_without_air_is_timed_all_the_same_and_the_arm_finds_the_block_loose(tmp_path: Path) -> None:
    """Nothing senses it: this is why `timed` is not `reached`."""
    done = with_fault("vice_without_air")
    assert done.run(tmp_path).outcome == "loose"
    assert {"root/close timed", "root/pull picked"} <= set(done.left)
    assert done.last("block").xyz[2] > 0.2


@pytest.mark.parametrize(
    ("name", "left", "reason"),
    [
        ("no_air", "root/bring no_air", "the pressure switch air is off"),
        ("stuck_slide", "root/bring stuck", "at_front is on, at_back is off after 3 s; nothing has changed"),
        ("wrong_sensor", "root/bring sensor_contradicts", "at_front and at_back of the axis travel are both on"),
        ("stuck_jaw", "root/pull picked", ""),
    ],
)
def test_each_fault_is_an_outcome_with_its_cause(tmp_path: Path, name: str, left: str, reason: str) -> None:
    """A main jaw that is stuck is found by the arm only."""
    done = with_fault(name)
    result = done.run(tmp_path)
    assert result.outcome == ("equipment_failed" if reason else "loose")
    assert left in done.left
    assert reason in causes(result)
