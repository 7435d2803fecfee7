"""A process is killed at every event of a run and around every commit; another resumes it; the end is the same.

The processes and their devices are those of `benchmarks/crash_recovery.py`. Effects are lines in a file.
"""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import msgspec
import pytest

from benchmarks.crash_trial import Trial
from tests.tiers import nightly

ROOT = Path(__file__).parents[4]


def trials(folder: Path, subject: str, *options: str) -> list[Trial]:
    """Make the trials of one subject; nothing may have gone wrong in any."""
    file = folder / "trials.json"
    command = [
        sys.executable,
        "-P",
        str(ROOT / "benchmarks" / "crash_recovery.py"),
        "--subject",
        subject,
        "--json",
        str(file),
    ]
    done = subprocess.run([*command, *options], cwd=folder, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    return msgspec.json.decode(file.read_bytes(), type=dict[str, list[Trial]])[subject]


@pytest.mark.parametrize("every_th", [16, nightly(1)])
def test_work_that_may_be_done_again_ends_the_same(tmp_path: Path, every_th: int) -> None:
    """Nothing is left out; what was in mid-work, in two branches at most, may have happened twice."""
    made = trials(tmp_path, "press", "--every", str(every_th))
    assert len(made) > 100 // every_th
    every = {"left one", "left two", "right a", "right b", "right c", "note 1", "note 2", "note 3", "close", "seal"}
    assert all(set(trial.effects) == every for trial in made)
    assert max(len(trial.effects) for trial in made) <= len(every) + 2


@pytest.mark.parametrize("every_th", [10, nightly(1)])
def test_what_must_not_be_repeated_happens_once_when_somebody_looks_and_answers(tmp_path: Path, every_th: int) -> None:
    """States that ask have their effect exactly once; those that take an outcome at most once."""
    made = trials(tmp_path, "glue", "--every", str(every_th))
    assert len(made) > 50 // every_th
    for trial in made:
        assert sorted(set(trial.effects)) == sorted(trial.effects)
        assert {"left bead", "right bead", "seal"} <= set(trial.effects)


@pytest.mark.parametrize("every_th", [18, nightly(1)])
def test_a_run_that_is_stepped_back_ends_the_same_wherever_its_engine_dies(tmp_path: Path, every_th: int) -> None:
    """The last state, in mid-work, and the two in a container before it are taken back, in whichever engine."""
    made = trials(tmp_path, "revised", "--every", str(every_th))
    assert len(made) > 50 // every_th
    assert all({"one", "two", "three", "last"} <= set(trial.effects) for trial in made)
    assert any({"no two", "no three"} <= set(trial.effects) for trial in made)


@pytest.mark.parametrize("every_th", [20, nightly(7)])
@pytest.mark.parametrize("subject", [nightly("press"), "glue"])
def test_crashes_in_a_row_while_it_is_resumed_change_nothing(tmp_path: Path, subject: str, every_th: int) -> None:
    """The next engine dies at its first event, then one at its fourth, then one at its ninth."""
    made = trials(tmp_path, subject, "--every", str(every_th), "--again", "1", "4", "9")
    assert max(trial.engines for trial in made) == 5


@pytest.mark.nightly
def test_the_two_arm_transfer_in_physics_is_resumed_with_its_parts_in_the_grippers(tmp_path: Path) -> None:
    """The arms stand where they were, the parts are where they were, and both trays are swapped in the end."""
    made = trials(tmp_path, "transfer", "--every", "61")
    assert len({trial.durable for trial in made}) >= 300 // 61
