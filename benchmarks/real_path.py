"""Applications through real drivers, with physics behind their emulators: `python -P -m benchmarks.real_path`.

Each runs its shipped behavior twice for each seed: with everything simulated, in virtual time, and by its drivers
against `flexcell emulate cell`. The parts must lie where they should in the world of the emulators.
Durations are those of the run, as it reports them; `late` is by how much the emulated world fell behind real time,
which is part of the duration.
"""

from __future__ import annotations

import argparse
import math
import re
import subprocess
import tempfile
from dataclasses import dataclass
from pathlib import Path

from benchmarks.comparison import machine
from tests.behaviors.real_path.emulated_cell import (
    PICK_AND_PLACE,
    PLATE_TRANSFER,
    TEST_CYLINDER,
    TWO_ARM_TRANSFER,
    EmulatedCell,
    RealPath,
    run_in,
)

_LIMIT_S = 900.0
_ENABLED = ("--enable", "emulated")


@dataclass(frozen=True)
class Goal:
    """Where a part of an application must lie in the end."""

    path: RealPath
    part: str
    xyz_m: tuple[float, float, float]
    within_m: float


# The seed displaces parts. A 2F-85 centres its part; a magnet carries it as it lies.
GOALS = (
    Goal(PICK_AND_PLACE, "payload", (-0.2, 0.98, 0.05), 0.02),
    Goal(PLATE_TRANSFER, "plate", (1.1, 0.7, 0.704), 0.035),
    Goal(TEST_CYLINDER, "test_cylinder", (0.0, 0.225, 0.275), 0.01),
    Goal(TWO_ARM_TRANSFER, "hca_north", (-0.11, -0.28, 0.026), 0.02),
)


def main() -> None:
    """Run all applications and print a table."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--only", default="", help="applications whose name has these words (default all)")
    parser.add_argument("--seeds", type=int, default=2, help="runs of each application (default 2)")
    options = parser.parse_args()
    print(
        f"{machine()}\n\n| application | seed | success | off its place, mm | simulated, s | real path, s | late, s |"
    )
    print("|---|---|---|---|---|---|---|", flush=True)
    for goal in (each for each in GOALS if options.only in each.path.name):
        for seed in range(1, options.seeds + 1):
            print(_row(goal, seed), flush=True)


def _row(goal: Goal, seed: int) -> str:
    with tempfile.TemporaryDirectory() as name, EmulatedCell(goal.path, Path(name), seed=seed) as emulated:
        simulated = run_in(
            emulated.cell, goal.path, "--simulate", "all", "--clock", "virtual", "--seed", str(seed), limit_s=_LIMIT_S
        )
        before_s = emulated.state()["late_s"]
        driven = emulated.run(*_ENABLED, limit_s=_LIMIT_S)
        state = emulated.state()
        off_m = math.dist(emulated.part(goal.part), goal.xyz_m)
    success = driven.returncode == simulated.returncode == 0 and off_m <= goal.within_m
    return (
        f"| {goal.path.name} | {seed} | {'yes' if success else 'no'} | {1e3 * off_m:.1f} | {_duration(simulated)} "
        f"| {_duration(driven)} | {state['late_s'] - before_s:.0f} |"
    )


def _duration(run: subprocess.CompletedProcess[str]) -> str:
    found = re.search(r" after ([\d.]+) s \(run ", run.stdout + run.stderr)
    return found.group(1) if found else "none"


if __name__ == "__main__":
    main()
