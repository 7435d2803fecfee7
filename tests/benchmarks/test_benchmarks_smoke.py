"""The benchmark scripts run, and every engine or channel they promise comes out in their tables."""

from __future__ import annotations

import json
import subprocess
import sys
from collections.abc import Sequence
from pathlib import Path

import pytest

from benchmarks import bus, engine
from benchmarks.comparison import MeasuredTable, Result, Row, Table
from benchmarks.sample import Sample
from tests.tiers import nightly

ROOT = Path(__file__).resolve().parents[2]


@pytest.mark.parametrize(("script", "tables"), [nightly("engine.py", engine.TABLES), ("bus.py", bus.TABLES)])
def test_a_quick_run_prints_every_table_with_every_peer(script: str, tables: Sequence[Table], tmp_path: Path) -> None:
    """Tiny sizes, one process a row; the figures mean nothing and are not looked at."""
    file = tmp_path / "figures.json"
    command = [sys.executable, str(ROOT / "benchmarks" / script), "--quick", "--json", str(file)]
    ended = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, check=False)
    assert ended.returncode == 0, ended.stderr
    for table in tables:
        _, _, below = ended.stdout.partition(f"### {table.title}\n")
        printed = [
            line.split("|")[1].strip() for line in below.partition("###")[0].splitlines() if line.startswith("|")
        ]
        assert printed[2:] == [row.name for row in table.rows]
    written = json.loads(file.read_text(encoding="utf-8"))
    assert [table["title"] for table in written["tables"]] == [table.title for table in tables]


def test_figures_are_medians_of_the_processes_and_ratios_to_the_first_row() -> None:
    """Three processes each; the second engine takes twice as long."""
    table = Table("T", (_row("ours"), _row("theirs")), {"µs": lambda r: f"{r.cpu_us:.0f}"}, lambda r: r.cpu_us)
    ours = Result(table.rows[0], tuple(Sample(10, cpu_s, 1.0) for cpu_s in (1e-5, 2e-5, 9e-5)))
    theirs = Result(table.rows[1], tuple(Sample(10, cpu_s, 1.0) for cpu_s in (4e-5, 4e-5, 1e-5)))
    assert MeasuredTable(table, (ours, theirs)).markdown().splitlines()[2:] == [
        "|        | µs | × ours |",
        "|--------|---:|-------:|",
        "| ours   |  2 |      1 |",
        "| theirs |  4 |      2 |",
    ]


def test_a_library_that_is_not_installed_is_named_in_its_row() -> None:
    """The others are still compared."""
    table = Table("T", (_row("ours"), _row("theirs")), {"µs": lambda r: f"{r.cpu_us:.0f}"}, lambda r: r.cpu_us)
    measured = MeasuredTable(
        table, (Result(table.rows[0], (Sample(1, 1e-6, 1.0),)), Result(table.rows[1], (), "x is missing"))
    )
    assert measured.markdown().splitlines()[-1] == "| theirs |  – | x is missing |"


def test_the_p99_of_a_row_is_that_of_its_middle_process() -> None:
    """One process with a hiccup does not decide."""
    calm = Sample(100, 1.0, 1.0, tuple(0.001 for _ in range(100)))
    hiccup = Sample(100, 1.0, 1.0, tuple(0.5 for _ in range(100)))
    assert Result(_row("ours"), (calm, hiccup, calm)).latency_ms(0.99) == pytest.approx(1.0)


def _row(name: str) -> Row:
    return Row(name, "nobody:nothing", (), ())
