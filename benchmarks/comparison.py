"""Runs tables of jobs in fresh processes, interleaved so that a busy machine is equally unfair to all."""

from __future__ import annotations

import json
import os
import platform
import statistics
import subprocess
import sys
from collections.abc import Callable, Sequence
from dataclasses import asdict, dataclass, field
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path

from benchmarks.sample import Sample

_ROOT = Path(__file__).resolve().parents[1]
_TIMEOUT_S = 300


@dataclass(frozen=True)
class Row:
    """One peer in a table: what it is called, its job as `module:function`, and how much it is given."""

    name: str
    job: str
    sizes: tuple[int, ...]
    quick: tuple[int, ...]
    remark: str = ""


@dataclass(frozen=True)
class Result:
    """The samples of one row, or why there are none."""

    row: Row
    samples: tuple[Sample, ...] = ()
    missing: str = ""

    @property
    def cpu_us(self) -> float:
        """CPU microseconds per unit, median of the processes."""
        return statistics.median(s.cpu_s / s.units for s in self.samples) * 1e6

    @property
    def wall_us(self) -> float:
        """Wall microseconds per unit, median of the processes."""
        return statistics.median(s.wall_s / s.units for s in self.samples) * 1e6

    @property
    def busy_ms_per_s(self) -> float:
        """CPU milliseconds per second of wall time, median of the processes."""
        return statistics.median(s.cpu_s / s.wall_s for s in self.samples) * 1e3

    def latency_ms(self, quantile: float) -> float:
        """A quantile of the latencies of each process, median of the processes, in milliseconds."""
        return statistics.median(_quantile(s.latencies_s, quantile) for s in self.samples) * 1e3


Columns = dict[str, Callable[[Result], str]]
"""Heading → cell."""


@dataclass(frozen=True)
class Table:
    """Rows that do the same work; `ratio` is compared with the first row, more is worse."""

    title: str
    rows: tuple[Row, ...]
    columns: Columns
    ratio: Callable[[Result], float]
    at_least_s: float = 0.3
    note: str = ""


@dataclass(frozen=True)
class MeasuredTable:
    """A table with its results."""

    table: Table
    results: tuple[Result, ...] = field(default_factory=tuple)

    def markdown(self) -> str:
        """Return it as a Markdown table with aligned columns."""
        headings = ["", *self.table.columns, f"× {self.table.rows[0].name}"]
        lines = [headings, *(self._cells(result) for result in self.results)]
        widths = [max(len(line[i]) for line in lines) for i in range(len(headings))]
        body = [f"| {' | '.join(_pad(line, widths))} |" for line in lines]
        rule = f"|{'|'.join('-' * (w + 1) + (':' if i else '-') for i, w in enumerate(widths))}|"
        remarks = [f"{r.row.name}: {r.row.remark}" for r in self.results if r.row.remark]
        notes = "".join(f"\n- {note}" for note in [*([self.table.note] if self.table.note else []), *remarks])
        return "\n".join([f"### {self.table.title}", "", body[0], rule, *body[1:]]) + (f"\n{notes}" if notes else "")

    def _cells(self, result: Result) -> list[str]:
        if not result.samples:
            return [result.row.name, *(["–"] * len(self.table.columns)), result.missing]
        own = self.table.ratio(self.results[0]) if self.results[0].samples else 0.0
        ratio = f"{self.table.ratio(result) / own:.3g}" if own else "–"
        return [result.row.name, *(cell(result) for cell in self.table.columns.values()), ratio]


def measure(table: Table, *, rounds: int, quick: bool) -> MeasuredTable:
    """Run every row in `rounds` fresh processes, one row after the other in each round."""
    found: dict[str, list[Sample | str]] = {row.name: [] for row in table.rows}
    for _ in range(rounds):
        for row in table.rows:
            at_least_s = 0.0 if quick else table.at_least_s
            found[row.name].append(_run(row.job, at_least_s, row.quick if quick else row.sizes))
    return MeasuredTable(table, tuple(_result(row, found[row.name]) for row in table.rows))


def report(measured: Sequence[MeasuredTable], packages: Sequence[str]) -> dict[str, object]:
    """Return everything that was measured, with what it was measured on, for JSON."""
    return {
        "machine": machine(),
        "versions": {name: _version(name) for name in packages},
        "tables": [{"title": m.table.title, "results": [asdict(result) for result in m.results]} for m in measured],
    }


def machine() -> str:
    """Describe the machine without naming it."""
    cores, load = os.cpu_count(), os.getloadavg()[0]
    return f"{cores} cores, load {load:.1f}, {platform.python_implementation()} {platform.python_version()}"


def _run(job: str, at_least_s: float, sizes: Sequence[int]) -> Sample | str:
    command = [sys.executable, "-m", "benchmarks.worker", job, str(at_least_s), *map(str, sizes)]
    # Everybody's modules are compiled once and kept, as those of an installation are.
    environment = {name: value for name, value in os.environ.items() if name != "PYTHONDONTWRITEBYTECODE"}
    ended = subprocess.run(
        command, cwd=_ROOT, env=environment, capture_output=True, text=True, timeout=_TIMEOUT_S, check=False
    )
    if ended.returncode != 0:
        raise RuntimeError(f"{job} failed:\n{ended.stderr}")
    answer = json.loads(ended.stdout.splitlines()[-1])
    if "missing" in answer:
        return f"{answer['missing']} is not installed"
    return Sample(answer["units"], answer["cpu_s"], answer["wall_s"], tuple(answer["latencies_s"]))


def _result(row: Row, found: Sequence[Sample | str]) -> Result:
    missing = next((f for f in found if isinstance(f, str)), "")
    return Result(row, tuple(f for f in found if isinstance(f, Sample)), missing)


def _quantile(values: Sequence[float], quantile: float) -> float:
    ordered = sorted(values)
    return ordered[min(int(len(ordered) * quantile), len(ordered) - 1)]


def _pad(cells: Sequence[str], widths: Sequence[int]) -> list[str]:
    return [c.rjust(w) if i else c.ljust(w) for i, (c, w) in enumerate(zip(cells, widths, strict=True))]


def _version(package: str) -> str:
    try:
        return version(package)
    except PackageNotFoundError:
        return "not installed"
