"""The shipped plate transfer through the driver of the IRC5 and of a magnet on its output, judged by their world."""

from __future__ import annotations

import subprocess
from pathlib import Path

import pytest

from tests.behaviors.real_path.emulated_cell import PLATE_TRANSFER, EmulatedCell, run_in
from tests.engine.cli.command import FLEXCELL
from tests.tiers import nightly

SWITCH = """
flexcell: 1
name: switch
cell: cells/irb4600.yaml
outcomes: [held, missed, failed]
success: [held]
root:
  machine:
    initial: "on"
    states:
      "on": {state: magnet.On, with: {magnet: arm}, transitions: {held: held, missed: missed, failed: failed}}
"""
CARRIED_M = 1.4
"""From the right pedestal to the left one, along y."""


@pytest.mark.timeout(900)
@pytest.mark.parametrize("seed", [1, nightly(2), nightly(3)])
def test_the_plate_lies_on_the_left_pedestal_in_the_world_of_the_emulators(tmp_path: Path, seed: int) -> None:
    """It is displaced there, and carried as it lies: the magnet does not centre it. An input tells that it is held."""
    with EmulatedCell(PLATE_TRANSFER, tmp_path, seed=seed) as emulated:
        x, y, z = emulated.part("plate")
        run = emulated.run("--enable", "the emulated cell is clear", limit_s=800.0)
        assert (run.returncode, (run.stdout + run.stderr)[-3000:]) == (0, (run.stdout + run.stderr)[-3000:])
        assert (x, y) != pytest.approx((1.1, -0.7), abs=1e-3)
        assert emulated.part("plate") == pytest.approx((x, y + CARRIED_M, z), abs=0.005)
        assert emulated.tilt_rad("plate") < 0.01
        assert emulated.state()["touched"]["arm"] == []


@pytest.mark.timeout(300)
def test_a_magnet_that_holds_nothing_in_the_world_of_the_emulators_has_missed(tmp_path: Path) -> None:
    """Its sensor is a signal of the controller, read over its web services."""
    with EmulatedCell(PLATE_TRANSFER, tmp_path) as emulated:
        behavior = tmp_path / "switch.yaml"
        behavior.write_text(SWITCH, encoding="utf-8")
        command = [FLEXCELL, "run", behavior, "--cell", emulated.cell, "--enable", "the emulated cell is clear"]
        command += ["--store", tmp_path / "store.db", "--journal", "none"]
        run = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, check=False, timeout=250)
        assert "run finished with missed " in run.stderr, run.stderr[-3000:]


def test_the_same_documents_run_with_everything_simulated(tmp_path: Path) -> None:
    cell = PLATE_TRANSFER.write_cell(tmp_path, "127.0.0.1")
    run = run_in(cell, PLATE_TRANSFER, "--simulate", "all", "--clock", "virtual", limit_s=300.0)
    assert (run.returncode, (run.stdout + run.stderr)[-3000:]) == (0, (run.stdout + run.stderr)[-3000:])
