"""A block is brought by a slide and clamped in a vice that has no sensors; each failure of the slide has its outcome."""

from __future__ import annotations

import math
from pathlib import Path

import pytest

from engine.cell.open_cell import OpenCell
from engine.document.faults import Faults, load_faults
from engine.messages import PartPoses, Vector3
from engine.runtime.run import Run
from engine.skills.simulated_world import PushBody
from tests.behaviors.application import BEHAVIORS, Application, causes, shipped_cell
from tests.tiers import nightly

BEHAVIOR = "vice/clamp_block.yaml"
# The block on the bed of the vice, and what its jaw holds: two faces, 120 N, 0.4.
HELD_AT: Vector3 = (0.5, 0.3, 0.14)
LIMIT_N = 96.0


def shipped_faults(name: str) -> Faults:
    """Return a fault file that ships with the behavior."""
    return load_faults(BEHAVIORS / "vice" / "faults" / f"{name}.yaml")


def pulled(force_n: float, at: list[float]) -> Application:
    """Return the application whose block is pulled upwards for a second once it is clamped; `at` takes its heights."""

    async def pull(run: Run, cell: OpenCell) -> None:
        clock = cell.bus.clock
        while not any(line.startswith("root/light") for line in done.left):
            await clock.sleep(0.05)
        for _ in range(2):
            parts = cell.bus.topic("cell/parts", PartPoses).latest
            assert parts is not None
            at.append(parts.poses["block"].xyz[2])
            if len(at) == 1:
                await cell.bus.call(PushBody(body="block", force_n=(0.0, 0.0, force_n), duration_s=1.0), to="cell")
                await clock.sleep(1.0)

    done = Application(behavior=BEHAVIOR, cell=shipped_cell("vice"), seed=1, meanwhile=pull)
    return done


@pytest.mark.parametrize("seed", [1, *map(nightly, range(2, 21))])
def test_the_block_is_clamped_where_the_side_jaws_centre_it(tmp_path: Path, seed: int) -> None:
    """The main jaw shifts it to the fixed jaw; across it is where the side jaws end, within half a millimetre each."""
    done = Application(behavior=BEHAVIOR, cell=shipped_cell("vice"), seed=seed)
    result = done.run(tmp_path)
    assert (result.outcome, causes(result)) == ("clamped", "")
    x, y, z = done.last("block").xyz
    assert x == pytest.approx(0.505, abs=0.002)
    assert y == pytest.approx(0.3, abs=0.0015)
    assert z == pytest.approx(0.14, abs=0.002)
    assert [line for line in done.left if "root/close" in line or "root/bring" in line] == [
        "root/bring reached",
        "root/close timed",
    ]


@pytest.mark.parametrize(
    ("name", "left", "reason"),
    [
        ("no_air", "root/bring no_air", "the pressure switch air is off"),
        ("stuck_slide", "root/bring stuck", "at_front is on, at_back is off after 3 s"),
        ("wrong_sensor", "root/bring sensor_contradicts", "at_front and at_back of the axis travel are both on"),
    ],
)
def test_each_fault_of_the_slide_is_an_outcome_with_its_cause(
    tmp_path: Path, name: str, left: str, reason: str
) -> None:
    done = Application(behavior=BEHAVIOR, cell=shipped_cell("vice"), seed=1, faults=shipped_faults(name))
    result = done.run(tmp_path)
    assert result.outcome == "equipment_failed"
    assert left in done.left
    assert reason in causes(result)


def test_a_vice_without_air_is_timed_all_the_same_and_does_not_hold(tmp_path: Path) -> None:
    """Nothing senses it: this is why `timed` is not `reached`."""
    done = Application(behavior=BEHAVIOR, cell=shipped_cell("vice"), seed=1, faults=shipped_faults("vice_without_air"))
    assert done.run(tmp_path).outcome == "clamped"
    assert "root/close timed" in done.left
    assert math.dist(done.last("block").xyz[:2], HELD_AT[:2]) < 0.003
