"""The benchmark of doubt continues where it ended, and tells each failure with its cause."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import msgspec
import pytest

from benchmarks import doubt, doubt_motions
from benchmarks.doubt import (
    APPLICATIONS,
    application_row,
    application_sweep,
    failure_rows,
    measure_figures,
    print_figures,
    run_application,
)
from engine.document import RealismName
from engine.sweep import SweepResults, SweepSubject, WorkerOptions, configurations


def test_figures_that_are_saved_are_not_measured_again(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    measured: list[tuple[str, RealismName]] = []

    def measure(name: str, realism: RealismName) -> str:
        measured.append((name, realism))
        return f"{len(measured)}"

    monkeypatch.setattr(doubt, "FIGURES", {"a": None, "b": None})
    monkeypatch.setattr(doubt, "measure_figure", measure)
    file = tmp_path / "figures.jsonl"
    measure_figures(file, ("ideal",), float("inf"))
    measure_figures(file, ("ideal", "typical"), float("inf"))
    measure_figures(file, ("poor",), 0.0)
    assert measured == [("a", "ideal"), ("b", "ideal"), ("a", "typical"), ("b", "typical")]
    print_figures(file, ("ideal", "typical", "poor"))
    assert capsys.readouterr().out.splitlines()[2:] == ["| a | 1 | 3 | – |", "| b | 2 | 4 | – |"]


@pytest.mark.virtual
def test_a_figure_is_of_an_arm_with_this_realism() -> None:
    """Friction leaves more than a tenth of a milliradian at rest."""
    name = next(iter(doubt_motions.FIGURES))
    still = [float(doubt_motions.measure_figure(name, realism).split(" /")[0]) for realism in ("ideal", "typical")]
    assert still[0] < 0.05 < 0.1 < still[1]


@pytest.mark.virtual
def test_the_seeds_of_an_application_are_executed_once_and_failures_have_their_cause(tmp_path: Path) -> None:
    sweep = application_sweep(APPLICATIONS["A4 test cylinder"], "typical", 1)
    with SweepResults.open(tmp_path / "runs.db") as saved:
        empty = run_application(sweep, saved, workers=1, execute=False)
        first = run_application(sweep, saved, workers=1, execute=True)
        second = run_application(sweep, saved, workers=1, execute=True)
    assert (len(empty.results), first.executed, second.executed) == (0, 1, 0)
    assert application_row("A4", "typical", empty) == "| A4 | typical | – | | | |"
    assert first.results[0].configuration.values == {"cell.world.realism": "typical"}
    failed = msgspec.structs.replace(first.results[0], success=False, outcome="failed", cause="it slipped")
    end = replace(first, results=[failed])
    assert failure_rows("A4", "typical", end) == ["| A4 | typical | 0 | failed | it slipped |"]
    assert application_row("A4", "typical", end).startswith("| A4 | typical | 0 of 1 |")
    hung = replace(first, results=[failed, msgspec.structs.replace(failed, status="hung", outcome=None)])
    assert application_row("A4", "typical", hung).startswith("| A4 | typical | 0 of 1 |")
    assert failure_rows("A4", "typical", hung)[-1] == "| A4 | typical | 0 | hung | it slipped |"


def test_a_busy_machine_ends_no_run(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    """A run gets hours of wall time, not the five minutes of other sweeps."""
    given: list[WorkerOptions] = []

    def execute(_subject: object, _planned: object, _saved: object, options: WorkerOptions, **_options: object) -> None:
        given.append(options)

    monkeypatch.setattr(doubt, "execute_sweep", execute)
    with SweepResults.open(tmp_path / "runs.db") as saved:
        run_application(
            application_sweep(APPLICATIONS["A4 test cylinder"], "typical", 1), saved, workers=1, execute=True
        )
    assert [options.timeout_s for options in given] == [7200.0]


def test_each_application_exists_and_its_seeds_are_its_own() -> None:
    for behavior in APPLICATIONS.values():
        planned = configurations(application_sweep(behavior, "typical", 50))
        assert len({configuration.seed for configuration in planned}) == 50
        SweepSubject.load(application_sweep(behavior, "typical", 1))
