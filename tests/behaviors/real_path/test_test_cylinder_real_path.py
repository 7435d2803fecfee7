"""The shipped test cylinder through the driver of the servo arm and of its claw on an output, judged by their world."""

from __future__ import annotations

from concurrent.futures import Future, ThreadPoolExecutor, wait
from pathlib import Path
from typing import Any

import pytest

from tests.behaviors.real_path.emulated_cell import TEST_CYLINDER, EmulatedCell, run_in
from tests.tiers import nightly

RACK_M = (0.0, 0.225, 0.275)
WATER_M = (0.18, 0.135, 0.275)
_ASK_S = 0.2


def path_of(part: str, emulated: EmulatedCell, done: Future[Any]) -> list[tuple[float, float, float]]:
    """Return where a part is in the world of the emulators, again and again until a run has ended."""
    passed = [emulated.part(part)]
    while not wait((done,), timeout=_ASK_S).done:
        passed.append(emulated.part(part))
    return passed


@pytest.mark.timeout(900)
@pytest.mark.parametrize("seed", [1, nightly(2), nightly(3)])
def test_the_cylinder_is_held_under_water_and_stands_in_its_rack_again(tmp_path: Path, seed: int) -> None:
    """Servos and claw report nothing: that the cylinder went along, only this world knows."""
    with EmulatedCell(TEST_CYLINDER, tmp_path, seed=seed) as emulated, ThreadPoolExecutor(1) as thread:
        running = thread.submit(emulated.run, "--enable", "the emulated cell is clear", limit_s=800.0)
        passed = path_of("test_cylinder", emulated, running)
        run = running.result()
        assert (run.returncode, (run.stdout + run.stderr)[-3000:]) == (0, (run.stdout + run.stderr)[-3000:])
        assert any(each == pytest.approx(WATER_M, abs=0.02) for each in passed)
        assert emulated.part("test_cylinder") == pytest.approx(RACK_M, abs=0.008)
        assert emulated.tilt_rad("test_cylinder") < 0.12
        assert emulated.state()["touched"]["arm"] == []


def test_the_same_documents_run_with_everything_simulated(tmp_path: Path) -> None:
    cell = TEST_CYLINDER.write_cell(tmp_path, "127.0.0.1")
    run = run_in(cell, TEST_CYLINDER, "--simulate", "all", "--clock", "virtual", limit_s=300.0)
    assert (run.returncode, (run.stdout + run.stderr)[-3000:]) == (0, (run.stdout + run.stderr)[-3000:])
