"""What a cold start costs: `python -P -m benchmarks.cold_start [--rounds N] [--json FILE]`.

Each row is a command in fresh processes, one row after the other in each round: CPU seconds of the process and of all
that it started. Modules are compiled before, as after the first use of an installation; that first round is not
counted. The last table tells where the CPU time of the run with two arms goes (`benchmarks.cold_start_profile`).
"""

from __future__ import annotations

import argparse
import json
import os
import resource
import statistics
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable, Mapping, Sequence
from dataclasses import asdict, dataclass
from pathlib import Path

from benchmarks.comparison import machine

_ROOT = Path(__file__).resolve().parents[1]
_TWO_STATES = """\
flexcell: 1
name: two_states
outcomes: [done]
success: [done]
root:
  machine:
    initial: first
    states:
      first: {state: flow.Wait, with: {duration_s: 0.1}, transitions: {done: second}}
      second: {state: flow.Wait, with: {duration_s: 0.1}, transitions: {done: done}}
"""
_TWO_ARMS = str(_ROOT / "behaviors" / "reconcycle" / "two_arm_transfer.yaml")
_RUNNING = "import engine.document, engine.runtime.plan, engine.runtime.run, engine.bus, engine.journal"
_FLEXCELL = "import sys; sys.argv[0] = 'flexcell'; from engine.cli.entry import main; main()"
_VIRTUAL = ("--clock", "virtual", "--journal", "none")


@dataclass(frozen=True)
class Cost:
    """What one process cost."""

    cpu_s: float
    wall_s: float
    output: str


def commands(behavior: str) -> Mapping[str, Sequence[str]]:
    """Return the arguments of Python for each row; `behavior` has two states and no cell."""

    def flexcell(*arguments: str) -> Sequence[str]:
        return ("-c", _FLEXCELL, *arguments)

    return {
        "Python alone": ("-c", "pass"),
        "`import asyncio`": ("-c", "import asyncio"),
        "`import engine`": ("-c", "import engine"),
        "imports to load, plan and run": ("-c", _RUNNING),
        "the same, and to check": ("-c", f"{_RUNNING}, engine.check"),
        "`flexcell --version`": flexcell("--version"),
        "`flexcell check`, two states": flexcell("check", behavior),
        "`flexcell check`, two arms": flexcell("check", _TWO_ARMS),
        "`flexcell run`, two states, virtual": flexcell("run", behavior, *_VIRTUAL),
        "`flexcell run`, two arms, virtual": flexcell("run", _TWO_ARMS, *_VIRTUAL),
    }


def cost(arguments: Sequence[str], environment: Mapping[str, str]) -> Cost:
    """Run Python with these arguments to its end.

    Raises:
        RuntimeError: it failed.
    """
    before, started_s = _children_s(), time.perf_counter()
    command = [sys.executable, "-P", *arguments]
    ended = subprocess.run(command, cwd=_ROOT, env=environment, capture_output=True, text=True, check=False)
    if ended.returncode != 0:
        raise RuntimeError(f"{arguments} failed:\n{ended.stderr}")
    return Cost(_children_s() - before, time.perf_counter() - started_s, ended.stdout)


def median(costs: Sequence[Cost], of: Callable[[Cost], float]) -> float:
    """Return the median of one figure."""
    return statistics.median(of(each) for each in costs)


def main() -> None:
    """Measure and print."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").partition("\n")[0])
    parser.add_argument("--rounds", type=int, default=7, help="fresh processes of each row (default 7)")
    parser.add_argument("--json", type=Path, metavar="FILE", help="write every sample to FILE")
    options = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        behavior = Path(folder) / "two_states.yaml"
        behavior.write_text(_TWO_STATES, encoding="utf-8")
        environment = _environment(Path(folder) / "compiled")
        rows = commands(str(behavior))
        split = ("-m", "benchmarks.cold_start_profile", "run", _TWO_ARMS, *_VIRTUAL)
        for arguments in (*rows.values(), split):
            cost(arguments, environment)
        found: dict[str, list[Cost]] = {name: [] for name in rows}
        splits: list[dict[str, float]] = []
        for _ in range(options.rounds):
            for name, arguments in rows.items():
                found[name].append(cost(arguments, environment))
            splits.append(json.loads(cost(split, environment).output.splitlines()[-1]))
    print(f"Medians and least of {options.rounds} fresh processes; {machine()}.\n")
    print(_table(found))
    print(_split_table(splits))
    if options.json:
        samples = {name: [asdict(each) for each in costs] for name, costs in found.items()}
        options.json.write_text(json.dumps({"machine": machine(), "rows": samples, "spans": splits}, indent=1) + "\n")


def _table(found: Mapping[str, Sequence[Cost]]) -> str:
    lines = ["| | CPU s | least CPU s | wall s |", "|---|--:|--:|--:|"]
    for name, costs in found.items():
        least_s = min(each.cpu_s for each in costs)
        cpu_s, wall_s = median(costs, lambda each: each.cpu_s), median(costs, lambda each: each.wall_s)
        lines.append(f"| {name} | {cpu_s:.3f} | {least_s:.3f} | {wall_s:.3f} |")
    return "\n".join(lines) + "\n"


def _split_table(splits: Sequence[Mapping[str, float]]) -> str:
    lines = ["| of the run with two arms | CPU s |", "|---|--:|"]
    names = sorted({name for split in splits for name in split})
    medians = {name: statistics.median(split.get(name, 0.0) for split in splits) for name in names}
    lines += [f"| {name} | {cpu_s:.3f} |" for name, cpu_s in sorted(medians.items(), key=lambda each: -each[1])]
    return "\n".join(lines) + "\n"


def _environment(compiled: Path) -> dict[str, str]:
    """Return the environment of the processes, in which compiled modules are kept in a folder."""
    own = {name: value for name, value in os.environ.items() if name != "PYTHONDONTWRITEBYTECODE"}
    return {**own, "PYTHONPYCACHEPREFIX": str(compiled), "PYTHONPATH": str(_ROOT)}


def _children_s() -> float:
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


if __name__ == "__main__":
    main()
