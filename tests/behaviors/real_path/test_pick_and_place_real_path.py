"""The shipped pick and place through the drivers of the UR10 and the 2F-85, judged by the world of the emulators."""

from __future__ import annotations

import subprocess
from pathlib import Path

import pytest

from tests.behaviors.real_path.emulated_cell import PICK_AND_PLACE, EmulatedCell, run_in
from tests.engine.cli.command import FLEXCELL
from tests.robots.drivers.universal_robots.client_library import needs_client_library
from tests.tiers import nightly

PLACE_M = (-0.2, 0.98, 0.05)
CELL = """\
flexcell: 1
cell: bench
world: {kind: mujoco}
robots:
  arm: {model: %s}
"""
HAND = "panda, gripper: {model: softhand, driver: {kind: softhand, device: /dev/ttyUSB0}}"
APART = (
    "fr3, driver: {kind: franka, host: 127.0.0.3}, "
    "gripper: {model: panda_hand, driver: {kind: franka_hand, host: 127.0.0.4}}"
)
BOARD = "servo_arm, driver: {kind: servo_arm, device: /dev/ttyACM0}"


@needs_client_library
@pytest.mark.timeout(900)
@pytest.mark.parametrize("seed", [1, nightly(2), nightly(3)])
def test_the_payload_stands_at_its_place_in_the_world_of_the_emulators(tmp_path: Path, seed: int) -> None:
    """The part is displaced there, and the engine is not told how: the fingers centre it, by contact."""
    with EmulatedCell(PICK_AND_PLACE, tmp_path, seed=seed) as emulated:
        started = emulated.part("payload")
        assert started != pytest.approx((0.2, 0.7, 0.05), abs=1e-4)
        run = emulated.run("--enable", "the emulated cell is clear", limit_s=800.0)
        assert (run.returncode, (run.stdout + run.stderr)[-3000:]) == (0, (run.stdout + run.stderr)[-3000:])
        assert emulated.part("payload") == pytest.approx(PLACE_M, abs=0.015)
        assert emulated.tilt_rad("payload") < 0.02
        assert emulated.state()["touched"]["arm"] == []


def test_the_same_documents_run_with_everything_simulated(tmp_path: Path) -> None:
    """No emulator is there: nothing connects to the addresses of the drivers."""
    cell = PICK_AND_PLACE.write_cell(tmp_path, "127.0.0.1")
    run = run_in(cell, PICK_AND_PLACE, "--simulate", "all", "--clock", "virtual", limit_s=300.0)
    assert (run.returncode, (run.stdout + run.stderr)[-3000:]) == (0, (run.stdout + run.stderr)[-3000:])


@pytest.mark.parametrize(
    ("arm", "reason"),
    [
        (HAND, "an emulated hand cannot be at /dev/ttyUSB0"),
        (BOARD, "an emulated board cannot be at /dev/ttyACM0"),
        (APART, "the hand of arm is at 127.0.0.4, its arm is not"),
    ],
)
def test_a_device_without_a_place_in_an_emulated_cell_is_refused_by_name(tmp_path: Path, arm: str, reason: str) -> None:
    cell = tmp_path / "cell.yaml"
    cell.write_text(CELL % arm, encoding="utf-8")
    command = [FLEXCELL, "emulate", "cell", f"file={cell}"]
    refused = subprocess.run(command, capture_output=True, text=True, check=False, timeout=120.0)
    assert (refused.returncode, reason in refused.stderr) == (2, True)
