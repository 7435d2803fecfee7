"""Random losses while two arms move in one cell: `python -P -m benchmarks.chaos [--trials N] [--first N] [--losses …]`.

Each trial starts a real `flexcell serve` with two Pandas that plan around each other and a depth camera, waits a random
time, and then kills or suspends a process of it. It passes when everything came to rest, the cause is named, and the
cell goes on afterwards: the run is resumed (or says why not), or a new one runs. Exit code 1 when a trial fails.
The disk that gets full is one in memory, mounted for the server alone; the clock that jumps is that of its processes
only.
"""

from __future__ import annotations

import argparse
import random
import sys
import tempfile
import time
from pathlib import Path

import httpx

from benchmarks.chaos_losses import LOSSES, Loss, LossResult, TrialFailure, moving_run


def main() -> int:
    """Carry out the trials and print a line for each."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--trials", type=int, default=200)
    parser.add_argument("--first", type=int, default=0, help="number of the first trial, to go on with an earlier run")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--losses", nargs="+", choices=list(LOSSES), default=list(LOSSES))
    options = parser.parse_args()
    failed = 0
    for number in range(options.first, options.first + options.trials):
        chance = random.Random(options.seed * 100_000 + number)
        name = options.losses[number % len(options.losses)]
        ended = _trial(LOSSES[name], chance)
        failed += bool(ended.wrong)
        rest = "-" if ended.rest_s is None else f"{ended.rest_s:.2f} s"
        print(f"{number:4} {name:18} rest {rest:>7}  {ended.after:24} {ended.wrong or ended.cause}", flush=True)
    print(f"{options.trials - failed} of {options.trials} trials passed")
    return 1 if failed else 0


def _trial(loss: Loss, chance: random.Random) -> LossResult:
    with tempfile.TemporaryDirectory() as folder:
        try:
            with loss.server(Path(folder) / "cell") as running:
                run = moving_run(running)
                time.sleep(chance.uniform(0.0, 2.0))
                return loss.happens(running, run, chance)
        except httpx.HTTPStatusError as error:
            answer = error.response
            return LossResult(wrong=f"FAILED: {error.request.url.path} answers {answer.status_code}: {answer.text}")
        except (TrialFailure, httpx.HTTPError, OSError) as error:
            return LossResult(wrong=f"FAILED: {error}")


if __name__ == "__main__":
    sys.exit(main())
