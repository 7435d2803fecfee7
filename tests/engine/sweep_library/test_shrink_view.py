"""A failing run of a sweep shrunk for a page, and saved as a test case of the project."""

from __future__ import annotations

from pathlib import Path

import msgspec
import pytest

from engine.document.sweep import load_sweep
from engine.errors import ControlError
from engine.sweep.shrinking import ShrinkProgress
from engine.sweep_library.shrink_view import ShrunkTrial
from engine.sweep_library.sweep_reader import SweepReader
from engine.sweep_library.sweep_requests import ReadRuns, SaveCase, ShrinkTrial
from tests.engine.sweep.luck_project import LuckProject
from tests.engine.sweep_library.saved_sweeps import ID, execute_runs, read, refused

CASE = "tests/cases/luck.yaml"


@pytest.fixture
def project(tmp_path: Path) -> LuckProject:
    """A project with a sweep of six runs that were executed."""
    made = LuckProject(tmp_path)
    made.write(runs=6, parameters={"otherwise": "raise"})
    execute_runs(tmp_path, 6)
    return made


def shrunk(project: LuckProject) -> ShrunkTrial:
    """The first failing run, shrunk."""
    failing = read(project.path, ReadRuns(sweep=ID))["runs"][0]["configuration"]["number"]
    return msgspec.convert(read(project.path, ShrinkTrial(sweep=ID, number=failing)), ShrunkTrial)


def test_a_failing_run_is_shrunk_with_progress_and_saved_as_a_case_that_fails(project: LuckProject) -> None:
    reader = SweepReader(project.path)
    failing = reader.runs(ID).runs[0].configuration
    shown: list[ShrinkProgress] = []
    found = reader.shrink(ID, failing.number, same="cause", show=shown.append)
    nominal, value = found.shrunk.changed["parameters.luck"]
    assert (nominal, found.failing) == (0.0, failing)
    assert 0.5 <= float(str(value)) <= float(str(failing.values["parameters.luck"])) + 0.01
    assert [each.runs for each in shown] == list(range(1, found.shrunk.runs + 1))
    assert reader.save_case(ID, CASE, found) == CASE
    case = load_sweep(project.path / CASE)
    assert case.document.factors["parameters.luck"].values == (value,)
    assert (case.document.require, case.document.runs) == ("success >= 1", 1)
    assert Path(case.resolve(case.document.behavior)) == project.behavior
    assert reader.list().sweeps[1].id == CASE


def test_a_run_that_succeeds_is_not_shrunk(project: LuckProject) -> None:
    good = read(project.path, ReadRuns(sweep=ID))["runs"][-1]["configuration"]["number"]
    assert refused(project.path, ShrinkTrial(sweep=ID, number=good)).kind == "state"
    assert refused(project.path, ShrinkTrial(sweep=ID, number=99)).kind == "missing"


@pytest.mark.parametrize("case", ["../case.yaml", "luck.yaml", "/tmp/case.yaml", "case"])
def test_a_case_is_a_new_file_of_the_project(project: LuckProject, case: str) -> None:
    assert refused(project.path, SaveCase(sweep=ID, case=case, found=shrunk(project))).kind == "invalid"


def test_what_was_shrunk_of_another_version_is_not_saved(project: LuckProject) -> None:
    found = shrunk(project)
    project.write(runs=6, parameters={"otherwise": "miss"})
    with pytest.raises(ControlError, match="has changed since"):
        SweepReader(project.path).save_case(ID, CASE, found)
    assert not (project.path / CASE).exists()
