"""How often an application succeeds with jittered parts, and whether a seed repeats byte for byte.

`python -P benchmarks/task_success_rate.py --seeds 20` runs the command a user runs, once a seed, then the
first seed again, and prints a table: for the two-arm transfer, or for `--behavior FILE`.
"""

from __future__ import annotations

import argparse
import json
import subprocess
import sys
import tempfile
import time
from pathlib import Path
from typing import Any

BEHAVIOR = Path(__file__).resolve().parents[1] / "behaviors" / "reconcycle" / "two_arm_transfer.yaml"
FLEXCELL = Path(sys.executable).with_name("flexcell")


def run(behavior: Path, seed: int, folder: Path) -> tuple[dict[str, Any], float]:
    """Run one seed in virtual time; returns the result and the wall time in seconds."""
    started = time.perf_counter()
    command = [FLEXCELL, "run", behavior, "--clock", "virtual", "--seed", str(seed), "--json"]
    done = subprocess.run(command, cwd=folder, capture_output=True, text=True, check=False)
    return json.loads(done.stdout), time.perf_counter() - started


def main() -> int:
    """Print the table; exit code 1 when fewer than 19 in 20 succeed or a repetition differs."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--seeds", type=int, default=20)
    parser.add_argument("--behavior", type=Path, default=BEHAVIOR)
    options = parser.parse_args()
    seeds, behavior = options.seeds, options.behavior.resolve()
    print("| seed | outcome | simulated s | wall s | cause |\n|---|---|---|---|---|")
    with tempfile.TemporaryDirectory() as name:
        results: list[dict[str, Any]] = []
        for seed in range(seeds):
            result, wall_s = run(behavior, seed, Path(name))
            results.append(result)
            cause = " because ".join(link["message"] for link in result["cause"])
            print(f"| {seed} | {result['outcome']} | {result['duration_s']:.2f} | {wall_s:.1f} | {cause} |", flush=True)
        again, _ = run(behavior, 0, Path(name))
    good = sum(result["success"] for result in results)
    same = again["events_sha256"] == results[0]["events_sha256"]
    print(f"\n{good} of {seeds} succeeded; seed 0 again: {'the same bytes' if same else 'DIFFERENT'}")
    return 0 if same and good * 20 >= seeds * 19 else 1


if __name__ == "__main__":
    sys.exit(main())
