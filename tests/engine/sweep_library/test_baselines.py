"""The versions that a page can compare a sweep with."""

from __future__ import annotations

from pathlib import Path

import pytest

from engine.sweep_library.sweep_requests import CompareSweep, FindBaselines
from tests.engine.sweep.luck_project import LuckProject
from tests.engine.sweep_library.saved_sweeps import ID, execute_runs, read, refused

RESULTS = ".flexcell/sweeps.db"


@pytest.fixture
def project(tmp_path: Path) -> LuckProject:
    """A project whose sweep was executed with a rate of 0.7 before, with 0.3 now, and with 0.5 into another file."""
    made = LuckProject(tmp_path)
    made.write(runs=20, parameters={"rate": 0.5})
    execute_runs(tmp_path, 5, results=tmp_path / "results" / "old.db")
    for rate in (0.7, 0.3):
        made.write(runs=20, parameters={"rate": rate})
        execute_runs(tmp_path, 20)
    return made


def test_baselines_are_found_in_all_files_of_results_the_latest_first(project: LuckProject) -> None:
    (project.path / "store.db").write_bytes(b"no results")
    (project.path / "empty.db").touch()
    newest, oldest = read(project.path, FindBaselines(sweep=ID))
    assert (newest["results"], newest["version"]["runs"]) == (RESULTS, 20)
    assert (oldest["results"], oldest["version"]["runs"]) == ("results/old.db", 5)
    assert newest["version"]["changed"] == ["parameters"]
    assert newest["version"]["saved_unix_s"] >= oldest["version"]["saved_unix_s"] > 0.0
    assert (project.path / "empty.db").read_bytes() == b""


def test_a_sweep_is_compared_with_the_version_that_is_chosen(project: LuckProject) -> None:
    chosen = read(project.path, FindBaselines(sweep=ID))[0]["version"]
    request = CompareSweep(sweep=ID, results=RESULTS, version=chosen["version"], margin=0.1)
    told = read(project.path, request)
    pair = told["comparison"]["pair"]
    assert pair["both"] + pair["only_first"] == chosen["successes"]
    assert pair["only_first"] > 0 == pair["only_second"]
    assert told["comparison"]["interval"][0] < -0.1
    assert told["verdict"] in ("failed", "undecided")
    assert f"0 mended and {pair['only_first']} broken" in told["words"]


@pytest.mark.parametrize("results", ["../old.db", "/etc/passwd", "sweep.yaml", "gone.db"])
def test_only_files_of_the_project_are_compared_with(project: LuckProject, results: str) -> None:
    assert refused(project.path, CompareSweep(sweep=ID, results=results, version="0")).kind == "missing"


def test_a_version_without_these_runs_is_no_baseline(project: LuckProject) -> None:
    told = refused(project.path, CompareSweep(sweep=ID, results=RESULTS, version="0"))
    assert "no other version has executed" in told.words[0]
