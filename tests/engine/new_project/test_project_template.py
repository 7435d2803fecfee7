"""A new project runs at once, with its own state and its own test; an example is copied with all that it needs."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest

from engine.errors import FlexcellError
from engine.new_project.examples import EXAMPLES, example_files
from engine.new_project.project_template import project_files, require_project_name, write_project
from tests.engine.cli.command import flexcell


@pytest.fixture(name="project")
def _project(tmp_path: Path) -> Path:
    said = flexcell("new", "press_cell", cwd=tmp_path)
    assert said.code == 0, said.err
    assert said.out.splitlines() == [
        "press_cell/",
        "Run it: cd press_cell && flexcell run behaviors/move_block.yaml --clock virtual",
        "Then read README.md there.",
    ]
    return tmp_path / "press_cell"


def test_a_new_project_has_no_finding_and_its_name_everywhere(project: Path) -> None:
    files = [str(path.relative_to(project)) for path in project.rglob("*") if path.is_file()]
    assert {"flexcell.yaml", "press_cell/measure_width.py", ".gitignore", ".github/workflows/cell.yml"} <= set(files)
    assert not [file for file in files if "PROJECT_NAME" in file or file.endswith(".txt")]
    assert not [file for file in files if "PROJECT_NAME" in (project / file).read_text(encoding="utf-8")]
    said = flexcell("check", "flexcell.yaml", "cells/cell.yaml", "behaviors/move_block.yaml", cwd=project)
    assert (said.code, said.err) == (0, "3 checked: 0 errors, 0 warnings\n"), said.out


def test_the_tests_of_a_new_project_pass_with_the_plugin(project: Path) -> None:
    """In a process of their own, as a user starts them: its root folder is that of the project."""
    command = [sys.executable, "-P", "-m", "pytest", "-q", "-p", "no:cacheprovider", "-k", "2 or missed"]
    done = subprocess.run(command, cwd=project, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stdout + done.stderr
    assert "2 passed" in done.stdout


@pytest.mark.parametrize("name", ["Press", "1cell", "a-b", "", "robots", "tests", "x" * 65])
def test_a_name_that_is_none_of_a_package_is_refused(name: str) -> None:
    with pytest.raises(FlexcellError):
        require_project_name(name)


def test_what_is_there_already_stays_as_it_is(project: Path) -> None:
    (project / "README.md").write_text("mine", encoding="utf-8")
    said = flexcell("new", "press_cell", cwd=project.parent)
    assert (said.code != 0, "is there already" in said.err) == (True, True)
    assert (project / "README.md").read_text(encoding="utf-8") == "mine"


def test_a_folder_that_cannot_be_written_is_named(tmp_path: Path) -> None:
    (tmp_path / "file").write_text("", encoding="utf-8")
    with pytest.raises(FlexcellError, match="cannot be written"):
        write_project(tmp_path / "file" / "cell", project_files("cell_1"))


@pytest.mark.parametrize("name", EXAMPLES)
def test_an_example_is_copied_with_all_that_it_needs(tmp_path: Path, name: str) -> None:
    write_project(tmp_path / "copy", example_files(name))
    said = flexcell("check", f"behaviors/{EXAMPLES[name].behavior}", "--targets", "off", cwd=tmp_path / "copy")
    assert (said.code, said.err) == (0, "1 checked: 0 errors, 0 warnings\n"), said.out


def test_an_example_runs_from_its_copy(tmp_path: Path) -> None:
    assert flexcell("new", "arm", "--example", "cylinder", cwd=tmp_path).code == 0
    behavior = f"behaviors/{EXAMPLES['cylinder'].behavior}"
    said = flexcell("run", behavior, "--clock", "virtual", "--seed", "1", cwd=tmp_path / "arm")
    assert said.code == 0, said.out + said.err


def test_examples_are_listed_and_a_name_that_is_none_suggests_one(tmp_path: Path) -> None:
    listed = flexcell("examples", cwd=tmp_path)
    assert [line.split()[0] for line in listed.out.splitlines()] == list(EXAMPLES)
    said = flexcell("new", "x", "--example", "plat", cwd=tmp_path)
    assert (said.code != 0, "did you mean plate?" in said.err) == (True, True)
    assert not (tmp_path / "x").exists()
