"""From a state to the lines of its class: of the project and of installed packages, and of nothing else."""

from __future__ import annotations

import inspect
from pathlib import Path

import pytest

from engine.editing import state_source
from engine.errors import RegistryError
from engine.registry import load_states
from states.flow.wait import Wait
from tests.engine.project_folder import STATE, ProjectFolder


def test_the_source_of_an_installed_state_is_its_class(tmp_path: Path) -> None:
    found = state_source(load_states(), "flow.Wait", project=tmp_path)
    lines, first = inspect.getsourcelines(Wait)
    shown = found.text.splitlines()[found.line - 1 : found.end_line]
    assert shown == [line.rstrip("\n") for line in lines]
    assert (found.line, found.in_project, Path(found.file)) == (first, False, Path(str(inspect.getsourcefile(Wait))))


def test_the_source_of_a_state_of_the_project_is_named_relative_to_it(tmp_path: Path) -> None:
    folder = ProjectFolder(tmp_path)
    name = folder.module()
    folder.allow(name)
    catalogue = load_states(tmp_path)
    found = state_source(catalogue, f"{name}:Nod", project=tmp_path)
    assert (found.file, found.in_project, found.text) == (f"{name}.py", True, STATE)
    assert STATE.splitlines()[found.line - 1].startswith("class Nod(")
    # What is on disk is shown, also while it cannot be imported.
    (tmp_path / f"{name}.py").write_text(f"# moved\n{STATE}", encoding="utf-8")
    assert state_source(catalogue, f"{name}:Nod", project=tmp_path).line == found.line + 1
    (tmp_path / f"{name}.py").write_text("class Nod(:", encoding="utf-8")
    assert state_source(catalogue, f"{name}:Nod", project=tmp_path).line == 1


@pytest.mark.parametrize("name", ["os:PathLike", "engine.registry", "../../etc/passwd", "/etc/passwd", "flow.Wai", ""])
def test_only_states_of_the_catalogue_have_a_source(tmp_path: Path, name: str) -> None:
    with pytest.raises(RegistryError, match="there is no such state"):
        state_source(load_states(), name, project=tmp_path)


def test_a_state_without_a_file_is_refused(tmp_path: Path) -> None:
    made = type("Made", (Wait,), {"__module__": "nowhere"})
    with pytest.raises(RegistryError, match="not a Python file"):
        state_source({"made": made}, "made", project=tmp_path)
