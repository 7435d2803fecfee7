"""Modules of the project's own states are loaded anew when they change, whole or not at all."""

from __future__ import annotations

import os
import sys
from collections.abc import Generator
from pathlib import Path

import pytest

from engine.check import check_behavior
from engine.document.loader import load_behavior
from engine.document.state_catalogue import StateCatalogue
from engine.library.state_reloading import StateReloading
from engine.registry import load_states
from tests.engine.project_folder import STATE, ProjectFolder

TWO_OUTCOMES = STATE.replace('("done",)', '("done", "lost")')


@pytest.fixture
def project(tmp_path: Path) -> Generator[ProjectFolder]:
    """A project whose modules are gone from this process afterwards."""
    before = set(sys.modules)
    yield ProjectFolder(tmp_path)
    for name in set(sys.modules) - before:
        if name.startswith(("module_", "package_")):
            del sys.modules[name]
    sys.path[:] = [each for each in sys.path if each != str(tmp_path)]


def opened(project: ProjectFolder, *modules: str) -> tuple[StateCatalogue, StateReloading]:
    """The states of a project that allows these modules."""
    project.allow(*modules)
    catalogue = load_states(project.path)
    return catalogue, StateReloading(project.path, catalogue)


def codes(project: ProjectFolder, catalogue: StateCatalogue, state: str) -> list[str]:
    """The findings of a behavior of one state."""
    return [each.code for each in check_behavior(load_behavior(project.behavior("only", state)), catalogue)]


def test_a_changed_class_is_a_new_one_in_a_fresh_module_and_the_old_one_stays_what_it_was(
    project: ProjectFolder,
) -> None:
    module = project.module()
    catalogue, reloading = opened(project, module)
    before, loaded = catalogue[f"{module}:Nod"], catalogue.modules[module]
    assert not reloading.is_due()
    assert not reloading.load()
    (project.path / f"{module}.py").write_text(TWO_OUTCOMES, encoding="utf-8")
    assert reloading.is_due()
    assert reloading.load()
    after = catalogue[f"{module}:Nod"]
    assert (before.outcomes, after.outcomes) == (("done",), ("done", "lost"))
    assert (vars(loaded)["Nod"], vars(sys.modules[module])["Nod"]) == (before, after)
    assert codes(project, catalogue, f"{module}:Nod") == ["unconnected-outcome"]
    assert not reloading.is_due()


def test_a_change_of_the_same_length_within_the_same_second_is_not_missed(project: ProjectFolder) -> None:
    """The compiled file says the same second and the same length."""
    module = project.module()
    catalogue, reloading = opened(project, module)
    file = project.path / f"{module}.py"
    was = file.stat()
    file.write_text(STATE.replace('("done",)', '("gone",)'), encoding="utf-8")
    os.utime(file, ns=(was.st_atime_ns, was.st_mtime_ns + 1))
    assert reloading.load()
    assert catalogue[f"{module}:Nod"].outcomes == ("gone",)


def test_an_error_at_import_is_a_finding_with_its_line_and_the_classes_stay(project: ProjectFolder) -> None:
    bad, good = project.module(), project.module()
    catalogue, reloading = opened(project, bad, good)
    before = {name: catalogue[f"{name}:Nod"] for name in (bad, good)}
    modules = {name: sys.modules[name] for name in (bad, good)}
    (project.path / f"{good}.py").write_text(TWO_OUTCOMES, encoding="utf-8")
    (project.path / f"{bad}.py").write_text(f"{STATE}\n1 / 0\n", encoding="utf-8")
    assert reloading.load()
    # All or none: two modules may share what has changed.
    assert {name: catalogue[f"{name}:Nod"] for name in (bad, good)} == before
    assert {name: sys.modules[name] for name in (bad, good)} == modules
    behavior = load_behavior(project.behavior("only", f"{bad}:Nod"))
    (found,) = check_behavior(behavior, catalogue)
    assert (found.code, found.severity, found.path) == ("outdated-state", "warning", "root/only")
    line = STATE.count("\n") + 2
    assert f"{bad}.py:{line}" in found.message
    assert "ZeroDivisionError" in found.message
    assert not reloading.is_due()
    (project.path / f"{bad}.py").write_text(TWO_OUTCOMES, encoding="utf-8")
    assert reloading.load()
    assert {catalogue[f"{name}:Nod"].outcomes for name in (bad, good)} == {("done", "lost")}
    assert codes(project, catalogue, f"{bad}:Nod") == ["unconnected-outcome"]


def test_a_module_that_was_broken_at_the_start_is_loaded_once_it_is_corrected(project: ProjectFolder) -> None:
    """It holds back no other module meanwhile."""
    bad, good = project.module("1 / 0"), project.module()
    catalogue, reloading = opened(project, bad, good)
    assert f"{bad}:Nod" not in catalogue
    (project.path / f"{good}.py").write_text(TWO_OUTCOMES, encoding="utf-8")
    assert reloading.load()
    assert catalogue[f"{good}:Nod"].outcomes == ("done", "lost")
    assert catalogue.outdated is None
    (project.path / f"{bad}.py").write_text(STATE, encoding="utf-8")
    assert reloading.load()
    assert catalogue[f"{bad}:Nod"].outcomes == ("done",)
    assert bad not in catalogue.broken


def test_what_a_module_imports_of_the_project_is_loaded_anew_too(project: ProjectFolder) -> None:
    """Of a package, and where what is imported is new and fails."""
    package = project.path / f"package_{project.module()[7:]}"
    package.mkdir()
    (package / "__init__.py").write_text("", encoding="utf-8")
    (package / "names.py").write_text('OUTCOMES = ("done",)\n', encoding="utf-8")
    text = STATE.replace('= ("done",)', "= OUTCOMES").replace(
        "from engine", f"from {package.name}.names import OUTCOMES\nfrom engine", 1
    )
    (package / "nod.py").write_text(text, encoding="utf-8")
    state = f"{package.name}.nod:Nod"
    catalogue, reloading = opened(project, f"{package.name}.nod")
    assert reloading.modules == {package.name, f"{package.name}.names", f"{package.name}.nod"}
    (package / "names.py").write_text('OUTCOMES = ("done", "lost")\n', encoding="utf-8")
    assert reloading.load()
    assert catalogue[state].outcomes == ("done", "lost")
    (package / "fresh.py").write_text("OUTCOMES = (", encoding="utf-8")
    (package / "nod.py").write_text(text.replace(".names", ".fresh"), encoding="utf-8")
    assert reloading.load()
    assert catalogue.outdated is not None
    assert catalogue[state].outcomes == ("done", "lost")
    (package / "fresh.py").write_text('OUTCOMES = ("fresh",)\n', encoding="utf-8")
    assert reloading.is_due()
    assert reloading.load()
    assert catalogue[state].outcomes == ("fresh",)


def test_installed_modules_and_flexcell_are_never_loaded_anew(project: ProjectFolder) -> None:
    module = project.module(STATE.replace("from typing", "import json\nfrom typing"))
    _, reloading = opened(project, module, "engine.state")
    assert reloading.modules == {module}
    wait = load_states(project.path)["flow.Wait"]
    (project.path / f"{module}.py").write_text(TWO_OUTCOMES, encoding="utf-8")
    assert reloading.load()
    assert load_states(project.path)["flow.Wait"] is wait


def test_additional_states_stay_and_a_plain_mapping_has_nothing_to_load(project: ProjectFolder) -> None:
    module = project.module()
    project.allow(module)
    wait = load_states()["flow.Wait"]
    catalogue = load_states(project.path).including({"mine.Wait": wait})
    reloading = StateReloading(project.path, catalogue)
    (project.path / f"{module}.py").write_text(TWO_OUTCOMES, encoding="utf-8")
    assert reloading.load()
    assert catalogue["mine.Wait"] is wait
    plain = StateReloading(project.path, {"mine.Wait": wait})
    assert not plain.is_due()
    assert not plain.load()
