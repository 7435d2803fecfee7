"""Garbage on the wire while an arm moves: `python -P -m benchmarks.fuzz_guided [--motions N] [--seed N]`.

An IRC5 guided by EGM, and a UR10 with `client: script`, move to and fro in an emulated cell with physics. A share of
the packets between driver and controller gets garbage beside or instead of it. The true joints must keep on the path
within its bounds, or rest; each motion that fails has a cause. Fails where one does not.
"""

from __future__ import annotations

import argparse
import asyncio
import logging
import sys
import tempfile
import time
from pathlib import Path

from benchmarks.comparison import machine
from tests.robots.drivers.arms_in_garbage import guided_in_garbage, ur_in_garbage
from tests.robots.drivers.motions_in_garbage import GarbageOutcome, move_in_garbage

# Garbage in a stream ends the connection: a small share of its packets is much.
_CASES = {
    "EGM, 5 % of packets": (guided_in_garbage, 0.05, 1.0),
    "EGM, half of the packets": (guided_in_garbage, 0.5, 1.0),
    "UR, RTDE, 0.5 % of packets": (ur_in_garbage, 0.005, 0.2),
}
_PATH_RAD, _REST_S = 0.05, 0.6


async def _measure(name: str, motions: int, *, seed: int) -> tuple[GarbageOutcome, float]:
    arm, share, of_motions = _CASES[name]
    begun_s = time.monotonic()
    with tempfile.TemporaryDirectory() as folder:
        async with arm(Path(folder), seed=seed) as moved:
            outcome = await move_in_garbage(moved, max(1, round(of_motions * motions)), share=share)
    return outcome, time.monotonic() - begun_s


def _row(name: str, outcome: GarbageOutcome, seconds: float) -> str:
    ends = ", ".join(f"{count} {end}" for end, count in outcome.ends.most_common())
    times_s = sorted(outcome.rest_s) or [0.0]
    return (
        f"| {name} | {outcome.ends.total()} | {outcome.garbage:,} | {ends} | {outcome.off_rad:.4f} |"
        f" {outcome.fastest_share:.2f} | {times_s[len(times_s) // 2]:.2f}, {times_s[-1]:.2f} | {seconds:.0f} |"
    )


def main() -> None:
    """Move in garbage and print the table."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("--motions", type=int, default=100, help="of each case, a fifth with RTDE (default 100)")
    parser.add_argument("--seed", type=int, default=1, help="of the garbage (default 1)")
    parser.add_argument("--only", default="", help="cases whose name has these words (default all)")
    options = parser.parse_args()
    logging.disable(logging.CRITICAL)
    print(
        f"{machine()}\n\n| wire | motions | garbage packets | ends | off the path, rad | of the speed limit |"
        " to rest, median and most, s | s |\n" + "|---" * 8 + "|"
    )
    failed: list[str] = []
    for name in _CASES:
        if options.only not in name:
            continue
        outcome, seconds = asyncio.run(_measure(name, options.motions, seed=options.seed))
        print(_row(name, outcome, seconds), flush=True)
        if outcome.unnamed or outcome.off_rad > _PATH_RAD or max(outcome.rest_s, default=0.0) > _REST_S:
            failed.append(f"{name}: {outcome}")
    if failed:
        sys.exit("\n".join(failed))


if __name__ == "__main__":
    main()
