"""The shipped two-arm transfer through libfranka, with FR3 in the places of the Pandas, judged by their simulator."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.behaviors.real_path.emulated_cell import TWO_ARM_TRANSFER, EmulatedCell, run_in
from tests.robots.drivers.franka.emulated_cabinet import needs_franka
from tests.tiers import nightly

TRAYS_M = 0.56
"""From one tray to the other, along y."""


@needs_franka
@pytest.mark.timeout(900)
@pytest.mark.parametrize("seed", [1, nightly(2), nightly(3)])
def test_both_parts_lie_in_the_other_tray_in_the_scene_of_the_simulator(tmp_path: Path, seed: int) -> None:
    """They are displaced and turned there, and held by the friction of the pads only."""
    with EmulatedCell(TWO_ARM_TRANSFER, tmp_path, seed=seed) as emulated:
        parts = ("hca_north", "hca_south")
        (_, north_y, north_z), (_, south_y, south_z) = (emulated.part(part) for part in parts)
        run = emulated.run("--enable", "the emulated cell is clear", limit_s=800.0)
        assert (run.returncode, (run.stdout + run.stderr)[-3000:]) == (0, (run.stdout + run.stderr)[-3000:])
        assert (north_y > 0.2, south_y < -0.2) == (True, True)
        assert emulated.part("hca_north") == pytest.approx((-0.11, 0.28 - TRAYS_M, north_z), abs=0.02)
        assert emulated.part("hca_south") == pytest.approx((0.11, -0.28 + TRAYS_M, south_z), abs=0.02)
        assert [emulated.tilt_rad(part) for part in parts] == pytest.approx([0.0, 0.0], abs=0.01)
        assert emulated.state()["touched"] == {"left": [], "right": []}


def test_the_same_documents_run_with_everything_simulated(tmp_path: Path) -> None:
    cell = TWO_ARM_TRANSFER.write_cell(tmp_path, "127.0.0.1")
    run = run_in(cell, TWO_ARM_TRANSFER, "--simulate", "all", "--clock", "virtual", limit_s=300.0)
    assert (run.returncode, (run.stdout + run.stderr)[-3000:]) == (0, (run.stdout + run.stderr)[-3000:])
