"""Sweeps in worker processes: results, resumption, parts, and every way in which a process can fail."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import tempfile
from collections.abc import Sequence
from pathlib import Path

import pytest

from engine.document.sweep import Sweep
from engine.errors import FlexcellError
from engine.sweep import (
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
from engine.sweep.results import without_costs
from tests.engine.sweep.luck_project import LuckProject

OPTIONS = WorkerOptions(workers=2, timeout_s=60.0)
ONE = WorkerOptions(workers=1, timeout_s=60.0)


@pytest.fixture(scope="module")
def project(tmp_path_factory: pytest.TempPathFactory) -> LuckProject:
    return LuckProject(tmp_path_factory.mktemp("luck"))


def _execute(
    sweep: Sweep,
    file: Path,
    *,
    options: WorkerOptions = OPTIONS,
    shard: Shard | None = None,
    again: bool = False,
    stop_after: int | None = None,
) -> SweepEnd:
    def show(progress: SweepProgress) -> None:
        if stop_after is not None and progress.executed >= stop_after:
            raise KeyboardInterrupt

    with SweepResults.open(file) as saved:
        return execute_sweep(
            SweepSubject.load(sweep), configurations(sweep), saved, options, shard=shard, again=again, show=show
        )


def _table(results: Sequence[TrialResult]) -> list[TrialResult]:
    return [without_costs(result) for result in results]


def _undisturbed(sweep: Sweep) -> list[TrialResult]:
    """The table of a sweep that is executed in this process, one run after the other."""
    trials = Trials(SweepSubject.load(sweep))
    return _table([trials.run(each) for each in configurations(sweep)])


def test_a_run_ends_alike_in_a_worker_and_in_this_process(project: LuckProject, tmp_path: Path) -> None:
    sweep = project.sweep(runs=6)
    end = _execute(sweep, tmp_path / "r.db")
    assert _table(end.results) == _undisturbed(sweep)
    assert (end.ended_by, end.executed, end.count.done) == ("runs", 6, 6)
    assert {each.success for each in end.results} == {True, False}
    assert all(each.success == (float(str(each.configuration.values["parameters.luck"])) < 0.5) for each in end.results)
    assert all(each.cpu_s > 0.0 and each.memory_bytes > 0 for each in end.results)


def test_saved_results_are_not_executed_again(project: LuckProject, tmp_path: Path) -> None:
    short, long = project.sweep(runs=4), project.sweep(runs=6)
    first = _execute(short, tmp_path / "r.db", options=ONE)
    second = _execute(long, tmp_path / "r.db", options=ONE)
    assert (first.executed, second.executed) == (4, 2)
    assert _table(second.results[:4]) == _table(first.results)
    assert _execute(long, tmp_path / "r.db", options=ONE).executed == 0


def test_a_result_that_was_saved_as_the_interrupt_came_is_counted(
    project: LuckProject, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    save = SweepResults.save

    def save_and_stop(results: SweepResults, key: str, subject: str, result: TrialResult, *, replace: bool) -> None:
        save(results, key, subject, result, replace=replace)
        raise KeyboardInterrupt

    monkeypatch.setattr(SweepResults, "save", save_and_stop)
    end = _execute(project.sweep(runs=4), tmp_path / "r.db", options=ONE)
    assert (end.ended_by, len(end.results), end.count.done) == ("interrupted", 1, 1)


def test_an_interrupted_sweep_keeps_what_has_ended_and_goes_on(project: LuckProject, tmp_path: Path) -> None:
    sweep = project.sweep(runs=8)
    first = _execute(sweep, tmp_path / "r.db", stop_after=3)
    assert (first.ended_by, first.executed) == ("interrupted", 3)
    with SweepResults.open(tmp_path / "r.db") as saved:
        assert len(saved_sweep(first.subject, first.configurations, saved).results) == 3
    second = _execute(sweep, tmp_path / "r.db")
    assert (second.ended_by, second.executed, len(second.results)) == ("runs", 5, 8)
    assert _table(second.results) == _undisturbed(sweep)


def test_parts_give_the_same_table_as_the_whole(project: LuckProject, tmp_path: Path) -> None:
    sweep = project.sweep(runs=7)
    parts = [tmp_path / f"{index}.db" for index in range(3)]
    ends = [_execute(sweep, file, options=ONE, shard=Shard(index=i, count=3)) for i, file in enumerate(parts)]
    assert [end.executed for end in ends] == [3, 2, 2]
    with SweepResults.open(tmp_path / "merged.db") as merged:
        assert merged.merge(parts) == 7
        joined = saved_sweep(ends[0].subject, ends[0].configurations, merged)
    assert _table(joined.results) == _undisturbed(sweep)


def test_a_decided_sweep_ends_early(project: LuckProject, tmp_path: Path) -> None:
    sweep = project.sweep(runs=500, parameters={"rate": 0.0}, require="success >= 0.5")
    # One process: of two, the second may execute many runs before the first one has ended its first.
    end = _execute(sweep, tmp_path / "r.db", options=ONE)
    assert (end.ended_by, end.count.verdict) == ("decided", "failed")
    assert end.executed < 20


def test_a_part_does_not_end_early(project: LuckProject, tmp_path: Path) -> None:
    sweep = project.sweep(runs=12, parameters={"rate": 0.0}, require="success >= 0.9")
    assert _execute(sweep, tmp_path / "r.db", options=ONE, shard=Shard(index=0, count=1)).executed < 12
    assert _execute(sweep, tmp_path / "p.db", options=ONE, shard=Shard(index=1, count=2)).executed == 6


def test_no_run_begins_after_the_time_of_a_sweep(project: LuckProject, tmp_path: Path) -> None:
    end = _execute(project.sweep(runs=50, time=0.0), tmp_path / "r.db")
    assert (end.ended_by, end.executed) == ("time", 0)


class TestFailingRuns:
    """A run that takes its process with it is an outcome of its configuration, and of no other."""

    def test_each_way_to_fail_is_its_result(self, project: LuckProject, tmp_path: Path) -> None:
        """One sweep of all of them: none may touch another."""
        ways = {
            "raise": ("errored", "the luck was"),
            "die": ("crashed", "the process of this run was ended by SIGKILL"),
            "exit": ("crashed", "the process of this run ended with exit code 7"),
            "eat": ("errored", "MemoryError"),
            "print": ("finished", ""),
            "forever": ("stopped", "longer than 30 s"),
        }
        factors = {"parameters.luck": {"values": [0.1, 0.9]}, "parameters.otherwise": {"values": list(ways)}}
        sweep = project.sweep(factors=factors, design="grid", runs=12, limit="30 s")
        options = WorkerOptions(workers=2, timeout_s=60.0, memory_bytes=2**30)
        results = _execute(sweep, tmp_path / "r.db", options=options).results
        assert len(results) == 12
        for result in results:
            values = result.configuration.values
            status, reason = ways[str(values["parameters.otherwise"])]
            if values["parameters.luck"] == 0.1:
                assert result.success, values
            else:
                assert (result.status, result.success) == (status, False), values
                assert reason in result.reason, values

    def test_a_run_that_hangs_is_ended(
        self, project: LuckProject, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
    ) -> None:
        scratch = tmp_path / "scratch"
        scratch.mkdir()
        monkeypatch.setenv("TMPDIR", str(scratch))
        monkeypatch.setattr(tempfile, "tempdir", None)
        sweep = project.sweep(
            factors={"parameters.luck": {"values": [0.1, 0.9]}}, design="grid", runs=2, parameters={"otherwise": "hang"}
        )
        # Long enough for a loaded machine to load the project and end the other run.
        end = _execute(sweep, tmp_path / "r.db", options=WorkerOptions(workers=2, timeout_s=12.0))
        assert [each.status for each in end.results] == ["finished", "hung"]
        assert "longer than 12 s" in end.results[1].reason
        assert list(scratch.iterdir()) == [], "a killed process leaves nothing behind"

    def test_a_value_that_is_refused_is_a_result_too(self, project: LuckProject, tmp_path: Path) -> None:
        sweep = project.sweep(factors={"parameters.luck": {"values": [0.1, 7.0]}}, design="grid", runs=2)
        end = _execute(sweep, tmp_path / "r.db", options=ONE)
        assert [each.status for each in end.results] == ["finished", "refused"]
        assert "luck" in end.results[1].reason

    def test_crashed_runs_are_executed_again_on_request_only(self, project: LuckProject, tmp_path: Path) -> None:
        sweep = project.sweep(runs=3, parameters={"rate": 0.0, "otherwise": "exit"})
        assert _execute(sweep, tmp_path / "r.db", options=ONE).executed == 3
        assert _execute(sweep, tmp_path / "r.db", options=ONE).executed == 0
        assert _execute(sweep, tmp_path / "r.db", options=ONE, again=True).executed == 3


def test_a_process_is_replaced_after_its_runs(project: LuckProject, tmp_path: Path) -> None:
    options = WorkerOptions(workers=1, timeout_s=60.0, runs_of_process=2)
    end = _execute(project.sweep(runs=5), tmp_path / "r.db", options=options)
    assert (end.executed, {each.status for each in end.results}) == (5, {"finished"})


def test_documents_that_change_during_a_sweep_end_it(tmp_path: Path) -> None:
    project = LuckProject(tmp_path)
    sweep = project.sweep(runs=50)
    subject = SweepSubject.load(sweep)
    text = project.behavior.read_text(encoding="utf-8")
    project.behavior.write_text(text.replace("default: 0.5", "default: 0.6"), encoding="utf-8")
    with SweepResults.open(tmp_path / "r.db") as saved:
        with pytest.raises(FlexcellError, match="is not as it was when the sweep began: behavior"):
            execute_sweep(subject, configurations(sweep), saved, ONE)
        assert saved.all_of(subject.hash) == []


def test_results_of_another_version_are_not_taken(tmp_path: Path) -> None:
    project = LuckProject(tmp_path)
    sweep = project.sweep(runs=3)
    assert _execute(sweep, tmp_path / "r.db", options=ONE).executed == 3
    module = tmp_path / f"{project.module}.py"
    module.write_text(f"{module.read_text(encoding='utf-8')}\n# Another version.\n", encoding="utf-8")
    assert _execute(sweep, tmp_path / "r.db", options=ONE).executed == 3


DRIVER = """
import os, signal, sys
from pathlib import Path
from engine.document.sweep import load_sweep
from engine.sweep import SweepResults, SweepSubject, WorkerOptions, configurations, execute_sweep

def show(progress):
    print(progress.executed, flush=True)
    if progress.executed == int(sys.argv[3]):
        os.kill(os.getpid(), signal.SIGKILL)

sweep = load_sweep(sys.argv[1])
with SweepResults.open(Path(sys.argv[2])) as saved:
    options = WorkerOptions(workers=2, timeout_s=60.0)
    execute_sweep(SweepSubject.load(sweep), configurations(sweep), saved, options, show=show)
"""


def test_kill_9_of_the_driver_loses_and_repeats_nothing(project: LuckProject, tmp_path: Path) -> None:
    file = project.write(runs=9)
    command = [sys.executable, "-c", DRIVER, str(file), str(tmp_path / "r.db"), "4"]
    killed = subprocess.run(command, capture_output=True, text=True, timeout=120, check=False)
    assert killed.returncode == -signal.SIGKILL, killed.stderr
    assert killed.stdout.split() == ["1", "2", "3", "4"]
    sweep = project.sweep(runs=9)
    second = _execute(sweep, tmp_path / "r.db")
    assert second.executed == 5
    assert _table(second.results) == _undisturbed(sweep)


def test_kill_9_of_a_worker_costs_the_run_that_it_had(project: LuckProject, tmp_path: Path) -> None:
    sweep = project.sweep(runs=8)
    killed: list[int] = []

    def show(progress: SweepProgress) -> None:
        if progress.executed == 2:
            children = Path(f"/proc/self/task/{os.getpid()}/children").read_text(encoding="ascii").split()
            killed.extend(int(each) for each in children if _is_worker(int(each)))
            for each in killed:
                os.kill(each, signal.SIGKILL)

    with SweepResults.open(tmp_path / "r.db") as saved:
        end = execute_sweep(SweepSubject.load(sweep), configurations(sweep), saved, OPTIONS, show=show)
    assert killed
    crashed = [each for each in end.results if each.status == "crashed"]
    assert len(crashed) <= len(killed)
    assert len(end.results) == 8
    again = _execute(sweep, tmp_path / "r.db", again=True)
    assert again.executed == len(crashed)
    assert _table(again.results) == _undisturbed(sweep)


def _is_worker(pid: int) -> bool:
    return b"engine.sweep.execution.worker" in Path(f"/proc/{pid}/cmdline").read_bytes()


def test_a_full_disk_ends_the_sweep_and_keeps_what_was_saved(project: LuckProject, tmp_path: Path) -> None:
    sweep = project.sweep(runs=40)
    file = tmp_path / "r.db"
    assert _execute(sweep, file, stop_after=2).executed == 2
    program = """
import resource, sys
from pathlib import Path
from engine.errors import FlexcellError
from engine.document.sweep import load_sweep
from engine.sweep import SweepResults, SweepSubject, WorkerOptions, configurations, execute_sweep

sweep = load_sweep(sys.argv[1])
file = Path(sys.argv[2])
with SweepResults.open(file) as saved:
    # A file cannot grow beyond this, as on a full disk.
    resource.setrlimit(resource.RLIMIT_FSIZE, (int(sys.argv[3]), resource.RLIM_INFINITY))
    try:
        execute_sweep(SweepSubject.load(sweep), configurations(sweep), saved, WorkerOptions(timeout_s=60.0))
    except FlexcellError as error:
        sys.exit(str(error))
"""
    wal = file.with_name(f"{file.name}-wal")
    limit = max(file.stat().st_size, wal.stat().st_size if wal.exists() else 0) + 30_000
    command = [sys.executable, "-c", program, str(project.write(runs=40)), str(file), str(limit)]
    ended = subprocess.run(command, capture_output=True, text=True, timeout=120, check=False)
    assert "results cannot be written" in ended.stderr, ended.stderr
    with SweepResults.open(file) as saved:
        kept = len(saved.all_of(SweepSubject.load(sweep).hash))
    assert 2 < kept < 40
    second = _execute(sweep, file)
    assert second.executed == 40 - kept
    assert len(second.results) == 40
