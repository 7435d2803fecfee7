"""What commands import: what the project of the user allows, and nothing that a recording or journal names."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.engine.cli.command import flexcell
from tests.engine.project_folder import STATE, ProjectFolder

WITH_TRACE = f"{STATE}\nwith open(__file__ + '.imported', 'a') as trace:\n    trace.write('x')\n"
PYTHON = """
from engine.authoring import behavior, state
from states.flow.wait import Wait
with open(__file__ + '.imported', 'a') as trace:
    trace.write('x')
rest = behavior("rest", outcomes=["done"], success=["done"], root=state(Wait(duration_s=0.01)))
"""


@pytest.fixture
def project(tmp_path: Path) -> ProjectFolder:
    (tmp_path / "mine").mkdir()
    return ProjectFolder(tmp_path / "mine")


def imports_of(project: ProjectFolder, module: str) -> int:
    """How often a module was run."""
    trace = project.path / f"{module}.py.imported"
    return len(trace.read_text(encoding="utf-8")) if trace.exists() else 0


def test_a_recording_imports_only_what_the_project_of_the_user_allows(project: ProjectFolder, tmp_path: Path) -> None:
    """The project file of the behavior counts for a run, that of the folder one works in for a replay."""
    module = project.module(WITH_TRACE)
    project.allow(module)
    project.behavior("nod", f"{module}:Nod")
    more = ("--clock", "virtual", "--journal", tmp_path / "journal", "--record", "nod.mcap", "-q")
    ran = flexcell("run", "mine/behaviors/nod.yaml", *more, cwd=tmp_path)
    assert (ran.code, imports_of(project, module)) == (0, 1), ran.err
    again = flexcell("replay", "../nod.mcap", cwd=project.path)
    assert (again.code, imports_of(project, module)) == (0, 2), again.err
    elsewhere = flexcell("replay", "nod.mcap", cwd=tmp_path)
    assert (elsewhere.code, imports_of(project, module)) == (2, 2), elsewhere.err
    assert f"the project does not allow documents to name the module `{module}`" in elsewhere.err


def test_a_journal_runs_no_python_file_by_itself(project: ProjectFolder) -> None:
    """Whoever resumes such a run says that it is to be run."""
    (project.path / "resting.py").write_text(PYTHON, encoding="utf-8")
    ran = flexcell("run", "resting.py:rest", "--clock", "virtual", "-q", cwd=project.path)
    assert (ran.code, imports_of(project, "resting")) == (0, 1), ran.err
    run = flexcell("runs", "--json", cwd=project.path).out
    run_id = run.partition('"id":"')[2].partition('"')[0]
    refused = flexcell("resume", run_id, cwd=project.path)
    assert (refused.code, imports_of(project, "resting")) == (2, 1)
    assert "if you trust the file, give --behavior" in refused.err
    told = flexcell("resume", run_id, "--behavior", "resting.py:rest", cwd=project.path)
    assert imports_of(project, "resting") == 2, told.err


def test_a_broken_module_hurts_the_behaviors_that_need_it_alone(project: ProjectFolder) -> None:
    """`check` names it with its line, and the project file can be checked itself."""
    module = project.module("\nraise SystemExit(3)")
    file = project.allow(module)
    bad, good = project.behavior("bad", f"{module}:Nod"), project.behavior("good")
    said = flexcell("check", good, bad, file, cwd=project.path)
    assert said.code == 2
    (line,) = said.out.splitlines()
    assert line.startswith(f"{bad}:9:")
    assert f"raised SystemExit: 3 at {project.path / module}.py:2" in line
    assert "[unknown-state]" in line
    listed = flexcell("states", cwd=project.path)
    assert (listed.code, "flow.Wait" in listed.out, f"loading `{module}` raised" in listed.err) == (0, True, True)
