"""The benchmark of cold starts counts each second once, and shows where those of a run go."""

from __future__ import annotations

import json
import subprocess
import sys
from pathlib import Path

import pytest

from benchmarks import cold_start_profile as cold_spans
from benchmarks.cold_start import commands, cost
from benchmarks.cold_start_profile import IMPORTS, REST, STARTUP, Spans

ROOT = Path(__file__).resolve().parents[2]


async def test_a_span_counts_without_those_inside_it(monkeypatch: pytest.MonkeyPatch) -> None:
    clock = iter((1.0, 1.0, 3.0, 6.0, 10.0, 15.0, 21.0))
    monkeypatch.setattr(cold_spans.time, "process_time", lambda: next(clock))
    spans = Spans()

    def inner() -> str:
        return "inner"

    async def outer() -> str:
        return spans.around(inner, "inside")()

    assert await spans.around(outer, "around")() == "inner"
    assert spans.total() == {STARTUP: 1.0, REST: 2.0 + 6.0, "around": 3.0 + 5.0, "inside": 4.0}


def test_the_spans_of_a_command_are_reported_after_what_it_prints(tmp_path: Path) -> None:
    """A check imports and does the rest; it opens no cell."""
    behavior = tmp_path / "b.yaml"
    behavior.write_text(
        "flexcell: 1\nname: b\noutcomes: [done]\nsuccess: [done]\nroot: {machine: {initial: w, states: {w: "
        "{state: flow.Wait, with: {duration_s: 0}, transitions: {done: done}}}}}\n",
        encoding="utf-8",
    )
    command = [sys.executable, "-m", "benchmarks.cold_start_profile", "check", str(behavior)]
    ended = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=False)
    assert (ended.returncode, ended.stderr) == (0, "1 checked: 0 errors, 0 warnings\n")
    spans = json.loads(ended.stdout.splitlines()[-1])
    assert set(spans) == {STARTUP, IMPORTS, REST}
    assert all(cpu_s > 0 for cpu_s in spans.values())


def test_a_row_that_fails_is_reported(tmp_path: Path) -> None:
    rows = commands(str(tmp_path / "missing.yaml"))
    with pytest.raises(RuntimeError, match=r"missing\.yaml"):
        cost(rows["`flexcell check`, two states"], {"PYTHONPATH": str(ROOT)})
