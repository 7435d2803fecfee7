"""Searches as they are executed: the same whatever the number of workers, resumed, and ended."""

from __future__ import annotations

from pathlib import Path

import pytest

from engine.document.sweep import Sweep
from engine.errors import FlexcellError
from engine.sweep import SweepResults, SweepSubject, TrialResult, WorkerOptions, configurations, run_sweep
from engine.sweep.search import SearchEnd, SearchProgress, execute_search, run_search, saved_search
from tests.engine.sweep.luck_project import LuckProject
from tests.engine.sweep.search.luck_search import ReversedPool, luck_result, luck_search


@pytest.fixture(scope="module")
def project(tmp_path_factory: pytest.TempPathFactory) -> LuckProject:
    return LuckProject(tmp_path_factory.mktemp("luck"))


@pytest.fixture
def without_processes(monkeypatch: pytest.MonkeyPatch) -> None:
    def new_executor(options: WorkerOptions, subject: SweepSubject) -> ReversedPool:
        return ReversedPool(subject, options)

    monkeypatch.setattr(WorkerOptions, "new_executor", new_executor)


def _execute(sweep: Sweep, file: Path, *, workers: int = 1, stop_after: int | None = None) -> SearchEnd:
    def show(progress: SearchProgress) -> None:
        if stop_after is not None and progress.executed >= stop_after:
            raise KeyboardInterrupt

    with SweepResults.open(file) as saved:
        return execute_search(SweepSubject.load(sweep), saved, WorkerOptions(workers=workers), show=show)


@pytest.mark.usefixtures("without_processes")
def test_the_number_of_workers_and_the_order_of_results_change_nothing(project: LuckProject, tmp_path: Path) -> None:
    sweep = luck_search(project)
    one, many = (_execute(sweep, tmp_path / f"{workers}.db", workers=workers) for workers in (1, 7))
    assert one.steps == many.steps
    assert (one.ended_by, one.executed, len(one.steps)) == ("runs", 60, 60)
    assert any(not step.result.success for step in one.steps)


@pytest.mark.usefixtures("without_processes")
@pytest.mark.parametrize("method", ["cross_entropy", "optuna"])
def test_an_interrupted_search_goes_on_where_it_was(project: LuckProject, tmp_path: Path, method: str) -> None:
    sweep = luck_search(project, method=method)
    file = tmp_path / "r.db"
    first = _execute(sweep, file, workers=3, stop_after=24)
    assert (first.ended_by, first.executed) == ("interrupted", 24)
    assert 20 <= len(first.steps) <= 24
    second = _execute(sweep, file)
    assert (second.ended_by, second.executed) == ("runs", 36)
    assert second.steps == _execute(sweep, tmp_path / "undisturbed.db").steps
    assert second.steps[: len(first.steps)] == first.steps


@pytest.mark.usefixtures("without_processes")
def test_a_result_that_was_saved_as_the_interrupt_came_is_counted(
    project: LuckProject, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    save = SweepResults.save

    def save_and_stop(results: SweepResults, key: str, subject: str, result: TrialResult, *, replace: bool) -> None:
        save(results, key, subject, result, replace=replace)
        raise KeyboardInterrupt

    monkeypatch.setattr(SweepResults, "save", save_and_stop)
    end = _execute(luck_search(project), tmp_path / "r.db")
    assert (end.ended_by, len(end.steps)) == ("interrupted", 1)


@pytest.mark.usefixtures("without_processes")
def test_it_ends_with_the_failures_it_is_for_and_shows_those_alone(project: LuckProject, tmp_path: Path) -> None:
    sweep = luck_search(project, stop_after=2)
    ends = [_execute(sweep, tmp_path / f"{workers}.db", workers=workers) for workers in (1, 6)]
    assert ends[0].steps == ends[1].steps
    assert {end.ended_by for end in ends} == {"failures"}
    assert sum(not step.result.success for step in ends[0].steps) == 2
    assert not ends[0].steps[-1].result.success
    assert ends[0].executed == len(ends[0].steps) < 60
    with SweepResults.open(tmp_path / "6.db") as saved:
        assert saved_search(SweepSubject.load(sweep), saved).steps == ends[0].steps


@pytest.mark.usefixtures("without_processes")
def test_it_takes_what_a_random_design_has_executed(project: LuckProject, tmp_path: Path) -> None:
    sweep = luck_search(project, runs=10)
    subject = SweepSubject.load(sweep)
    with SweepResults.open(tmp_path / "r.db") as saved:
        saved.describe(subject.hash, subject.versions)
        for configuration in configurations(sweep)[:8]:
            saved.save(configuration.key(subject.hash), subject.hash, luck_result(configuration))
    assert _execute(sweep, tmp_path / "r.db").executed == 2


@pytest.mark.usefixtures("without_processes")
def test_no_run_begins_after_the_time_of_a_search(project: LuckProject, tmp_path: Path) -> None:
    end = _execute(luck_search(project, time=0.0), tmp_path / "r.db")
    assert (end.ended_by, end.executed, end.steps) == ("time", 0, [])


def test_nothing_is_saved_of_a_search_that_was_not_executed(project: LuckProject, tmp_path: Path) -> None:
    with SweepResults.open(tmp_path / "r.db") as saved:
        end = saved_search(SweepSubject.load(luck_search(project)), saved)
    assert (end.ended_by, end.steps) == ("interrupted", [])


@pytest.mark.usefixtures("without_processes")
def test_what_is_saved_of_an_unknown_number_is_refused(project: LuckProject, tmp_path: Path) -> None:
    with pytest.raises(FlexcellError, match="no run has a number `gap_m`"):
        _execute(luck_search(project, towards="least gap_m"), tmp_path / "r.db")


@pytest.mark.usefixtures("without_processes")
def test_a_script_gets_what_was_found_and_no_success_rate(project: LuckProject, tmp_path: Path) -> None:
    sweep = luck_search(project, stop_after=2)
    found = run_search(sweep, results=tmp_path / "r.db", workers=1)
    assert len(found.failing) == 2
    with pytest.raises(FlexcellError, match="the sweep is a search"):
        run_sweep(sweep, results=tmp_path / "r.db")
    with pytest.raises(FlexcellError, match="the sweep has no search"):
        run_search(project.sweep(), results=tmp_path / "r.db")
