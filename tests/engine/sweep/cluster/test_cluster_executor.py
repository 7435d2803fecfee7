"""Sweeps on a Dask cluster with TLS: its scheduler and workers are processes, as they are on machines of their own."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest

from engine.document.sweep import Sweep
from engine.errors import FlexcellError
from engine.sweep import (
    ClusterOptions,
    Shard,
    SweepEnd,
    SweepProgress,
    SweepResults,
    SweepSubject,
    TrialResult,
    Trials,
    WorkerOptions,
    configurations,
    execute_sweep,
    saved_sweep,
)
from engine.sweep.cluster import cluster_executor
from engine.sweep.execution.trial_execution import ExecutionOptions
from engine.sweep.results import without_costs
from engine.sweep.subject.sweep_subject import environment_versions
from tests.engine.awaited import wait_until
from tests.engine.sweep.cluster.dask_processes import DaskProcesses
from tests.engine.sweep.luck_project import LuckProject


@pytest.fixture(scope="module")
def project(tmp_path_factory: pytest.TempPathFactory) -> LuckProject:
    return LuckProject(tmp_path_factory.mktemp("luck"))


@pytest.fixture(scope="module")
def cluster(tmp_path_factory: pytest.TempPathFactory) -> Iterator[DaskProcesses]:
    with DaskProcesses(tmp_path_factory.mktemp("cluster"), 2) as started:
        yield started


def _execute(
    sweep: Sweep, file: Path, options: ExecutionOptions, *, shard: Shard | None = None, stop_after: int | None = None
) -> SweepEnd:
    def show(progress: SweepProgress) -> None:
        if progress.executed == stop_after:
            raise KeyboardInterrupt

    with SweepResults.open(file) as saved:
        return execute_sweep(SweepSubject.load(sweep), configurations(sweep), saved, options, shard=shard, show=show)


def _table(end: SweepEnd) -> list[TrialResult]:
    return [without_costs(result) for result in end.results]


def test_a_sweep_ends_alike_here_in_parts_and_on_a_cluster(
    project: LuckProject, cluster: DaskProcesses, tmp_path: Path
) -> None:
    """Also where a run fails: its events then name files, which lie elsewhere on a worker."""
    factors = {
        "parameters.luck": {"values": [0.1, 0.9]},
        "parameters.otherwise": {"values": ["miss", "raise"]},
    }
    sweep = project.sweep(factors=factors, design="grid", runs=4)
    here = _execute(sweep, tmp_path / "here.db", WorkerOptions(workers=1))
    there = _execute(sweep, tmp_path / "there.db", cluster.options())
    parts = [tmp_path / f"{index}.db" for index in range(3)]
    for index, file in enumerate(parts):
        _execute(sweep, file, WorkerOptions(workers=1), shard=Shard(index=index, count=3))
    with SweepResults.open(tmp_path / "merged.db") as merged:
        assert merged.merge([*parts, tmp_path / "here.db", tmp_path / "there.db"]) == 4
        joined = saved_sweep(here.subject, here.configurations, merged)
    assert [each.status for each in here.results] == ["finished", "finished", "finished", "errored"]
    assert _table(there) == _table(here) == _table(joined)
    assert all(each.events_sha256 for each in there.results)
    assert (there.ended_by, there.executed) == ("runs", 4)


def test_an_interrupted_sweep_leaves_nothing_on_its_workers_and_goes_on(
    project: LuckProject, cluster: DaskProcesses, tmp_path: Path
) -> None:
    sweep = project.sweep(
        factors={"parameters.luck": {"values": [0.1, 0.2, 0.9]}}, design="grid", runs=3,
        parameters={"otherwise": "hang"},
    )  # fmt: skip
    first = _execute(sweep, tmp_path / "r.db", cluster.options(timeout_s=300.0), stop_after=2)
    assert first.ended_by == "interrupted"
    assert [(each.configuration.number, each.status) for each in first.results] == [(0, "finished"), (1, "finished")]
    wait_until(lambda: not cluster.processes_of_runs() and not cluster.folders_of_runs())
    second = _execute(sweep, tmp_path / "r.db", cluster.options(timeout_s=5.0))
    assert [each.status for each in second.results] == ["finished", "finished", "hung"]
    assert second.executed == 1


def test_a_worker_with_other_packages_is_refused(
    project: LuckProject, cluster: DaskProcesses, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    here = {**environment_versions(), "msgspec": "0.1"}
    monkeypatch.setattr(cluster_executor, "environment_versions", lambda: here)
    with pytest.raises(FlexcellError, match=r"\d of \d workers have other packages .*: msgspec \S+ instead of 0\.1"):
        _execute(project.sweep(runs=1), tmp_path / "r.db", cluster.options())


def test_a_run_whose_worker_is_lost_has_crashed_and_is_not_executed_again(
    project: LuckProject, cluster: DaskProcesses, tmp_path: Path
) -> None:
    """The state kills the worker of Dask, which executes again on another one what its lost workers had."""
    sweep = project.sweep(
        factors={"parameters.luck": {"values": [0.1, 0.9, 0.2, 0.3, 0.4]}}, design="grid", runs=5,
        parameters={"otherwise": "orphan"},
    )  # fmt: skip
    end = _execute(sweep, tmp_path / "r.db", cluster.options())
    assert [each.status for each in end.results] == ["finished", "crashed", "finished", "finished", "finished"]
    assert "was lost" in end.results[1].reason
    assert sum(worker.poll() is not None for worker in cluster.workers) == 1


def test_without_its_scheduler_a_sweep_keeps_what_has_ended(project: LuckProject, tmp_path: Path) -> None:
    sweep = project.sweep(runs=6)

    def show(progress: SweepProgress) -> None:
        if progress.executed == 2:
            cluster.scheduler.kill()

    with (
        DaskProcesses(tmp_path, 1) as cluster,
        SweepResults.open(tmp_path / "r.db") as saved,
        pytest.raises(FlexcellError, match="the scheduler of the cluster is gone") as caught,
    ):
        execute_sweep(SweepSubject.load(sweep), configurations(sweep), saved, cluster.options(), show=show)
    assert "the same command goes on" in str(caught.value.hint)
    here = _execute(sweep, tmp_path / "r.db", WorkerOptions(workers=1))
    assert (here.executed, len(here.results)) == (4, 6)
    trials = Trials(here.subject)
    assert _table(here) == [without_costs(trials.run(each)) for each in here.configurations]


def test_an_address_without_a_scheduler_is_refused(project: LuckProject, tmp_path: Path) -> None:
    with pytest.raises(FlexcellError, match="no scheduler answers there"):
        _execute(project.sweep(runs=1), tmp_path / "r.db", ClusterOptions(scheduler="tcp://127.0.0.1:1", connect_s=0.5))
