"""What a long `foreach` costs: `python -P -m benchmarks.foreach [--rounds N]`.

Each round sets a value, which is collected. Reported are the wall time of the whole run with its journal in a file, the
time of its first and last tenth, which are equal where each round costs the same, and how much the process has grown.
"""

from __future__ import annotations

import argparse
import asyncio
import resource
import tempfile
import time
from pathlib import Path

from engine.bus import SkillBus
from engine.clock import new_clock, run_virtual
from engine.document import parse_behavior
from engine.event import Event, NodeEntered
from engine.journal import Journal
from engine.registry import load_states
from engine.runtime.plan import new_plan
from engine.runtime.run import Run
from engine.runtime.run_result import RunResult

_BEHAVIOR = """
flexcell: 1
name: rounds
userdata: {all: []}
outcomes: [exhausted, broken]
success: [exhausted]
root:
  foreach:
    times: ROUNDS
    index: number
    collect: {square: all}
    child: {state: flow.SetValue, with: {value: "${number * number}"}, out: {value: square}}
    next: [done]
"""


def main() -> None:
    """Measure and print, in virtual and in real time."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--rounds", type=int, default=100_000)
    rounds = parser.parse_args().rounds
    print(f"{'clock':9}{'rounds':>9}{'s':>8}{'first tenth s':>15}{'last tenth s':>14}{'grown MB':>10}")
    for virtual in (True, False):
        before_mb = _peak_mb()
        work = _run(rounds)
        total_s, tenths_s = run_virtual(work) if virtual else asyncio.run(work)
        name = "virtual" if virtual else "real"
        print(
            f"{name:9}{rounds:9}{total_s:8.1f}{tenths_s[0]:15.2f}{tenths_s[-1]:14.2f}{_peak_mb() - before_mb:10.0f}",
            flush=True,
        )


async def _run(rounds: int) -> tuple[float, list[float]]:
    plan = new_plan(parse_behavior(_BEHAVIOR.replace("ROUNDS", str(rounds)), file="rounds.yaml"), load_states())
    marks_s: list[float] = []
    count = 0

    def look(event: Event) -> None:
        nonlocal count
        if isinstance(event, NodeEntered) and event.kind == "state":
            count += 1
            if count % (rounds // 10) == 0:
                marks_s.append(time.perf_counter())

    clock = new_clock()
    with tempfile.TemporaryDirectory() as folder, Journal.open(Path(folder), inline=clock.virtual) as journal:
        async with SkillBus(clock) as bus:
            begun = journal.begin("rounds", behavior="rounds.yaml", document="", started_unix_s=time.time())
            run = Run(plan, run="rounds", bus=bus, journal=begun)
            run.watch(look)
            started_s = time.perf_counter()
            result: RunResult = await run.execute()
            total_s = time.perf_counter() - started_s
    assert result.outcome == "exhausted", result.cause
    collected = result.userdata["all"]
    assert isinstance(collected, list)
    assert len(collected) == rounds  # pyright: ignore[reportUnknownArgumentType]
    return total_s, [after - before for before, after in zip([started_s, *marks_s], marks_s, strict=False)]


def _peak_mb() -> float:
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024.0


if __name__ == "__main__":
    main()
