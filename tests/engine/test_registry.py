"""Modules are loaded at one moment, because the project allows them; what they raise hurts whoever needs them."""

from __future__ import annotations

import sys
from collections.abc import Iterator, Sequence
from pathlib import Path

import pytest

import engine.registry
from engine.check import check_file
from engine.document import load_behavior
from engine.document.state_catalogue import find_state
from engine.errors import DocumentError, ModuleNotAllowed, RegistryError
from engine.registry import load_states, state_by_path
from engine.runtime.plan import new_plan
from engine.runtime.tree.behaviour_catalogue import find_behaviour
from tests.engine.project_folder import STATE, ProjectFolder, is_imported

FOREIGN = """
from py_trees.behaviour import Behaviour
from py_trees.common import Status

class Yes(Behaviour):
    def update(self) -> Status:
        return Status.SUCCESS
"""


@pytest.fixture
def project(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[ProjectFolder]:
    before = set(sys.modules)
    monkeypatch.setattr(sys, "path", list(sys.path))
    yield ProjectFolder(tmp_path)
    for name in set(sys.modules) - before:
        if name.startswith("module_"):
            del sys.modules[name]


def test_a_module_that_the_project_allows_brings_its_states(project: ProjectFolder) -> None:
    """Into the lists, and for behaviors anywhere in the project's folder."""
    module = project.module()
    project.allow(module)
    file = project.behavior("nod", f"{module}:Nod")
    catalogue = load_states(file)
    assert f"{module}:Nod" in catalogue
    assert check_file(file, catalogue) == ()
    assert new_plan(load_behavior(file), catalogue).outcomes == ("done",)


def test_a_state_with_a_name_is_found_by_it(project: ProjectFolder) -> None:
    module = project.module(STATE.replace("    outcomes", "    state_name: ClassVar[str] = 'mine.Nod'\n    outcomes"))
    project.allow(module)
    catalogue = load_states(project.path)
    assert catalogue["mine.Nod"] is catalogue[f"{module}:Nod"]


def test_a_module_that_is_not_allowed_is_not_imported_and_the_finding_says_which_line_to_add(
    project: ProjectFolder,
) -> None:
    module = project.module("raise SystemExit(3)")
    file = project.behavior("nod", f"{module}:Nod")
    (found,) = check_file(file, load_states(file))
    assert (found.code, found.position.line) == ("module-not-allowed", 9)
    assert f"write `flexcell: 1` and `states: [{module}]` into flexcell.yaml" in found.hint
    allowed = project.allow("engine.state")
    (found,) = check_file(file, load_states(file))
    assert found.hint == f"add `{module}` to `states` in {allowed}"
    with pytest.raises(DocumentError, match="does not allow"):
        new_plan(load_behavior(file), load_states(file))
    assert not is_imported(module)


@pytest.mark.parametrize(
    ("text", "raised"),
    [
        ("\nraise SystemExit(3)", "SystemExit: 3"),
        ("\nraise KeyboardInterrupt", "KeyboardInterrupt"),
        ("\n1 / 0", "ZeroDivisionError: division by zero"),
        ("\nimport nothing_of_this_name", "ModuleNotFoundError: No module named 'nothing_of_this_name'"),
        ("\nx = (", "SyntaxError: '(' was never closed"),
        ("\nclass Odd(BaseException):\n    def __str__(self): return 1 / 0\nraise Odd", "Odd"),
    ],
)
def test_what_a_module_raises_is_named_with_its_line_and_hurts_only_who_needs_it(
    project: ProjectFolder, text: str, raised: str
) -> None:
    bad, good = project.module(text), project.module()
    project.allow(bad, good)
    catalogue = load_states(project.path)
    with pytest.raises(RegistryError) as refused:
        find_state(catalogue, f"{bad}:Nod")
    line = text.count("\n") + 1
    assert f"loading `{bad}` raised {raised}" in refused.value.message
    assert refused.value.message.endswith(f"{bad}.py:{line}")
    assert str(refused.value.where) == f"{project.path / 'flexcell.yaml'}:2:10"
    assert find_state(catalogue, f"{good}:Nod").outcomes == ("done",)
    assert {"flow.Wait", f"{good}:Nod"} <= set(catalogue)


def test_a_missing_class_and_a_missing_state_bring_the_nearest(project: ProjectFolder) -> None:
    module = project.module()
    project.allow(module)
    catalogue = load_states(project.path)
    with pytest.raises(RegistryError, match=f"there is no state `{module}:Nob`.*did you mean {module}:Nod"):
        find_state(catalogue, f"{module}:Nob")
    with pytest.raises(RegistryError, match=r"did you mean flow\.Wait"):
        find_state(catalogue, "flow.Wiat")


def test_behaviours_of_py_trees_kind_need_the_same_leave(project: ProjectFolder) -> None:
    """Those of py_trees itself need none."""
    allowed, other = project.module(FOREIGN), project.module(FOREIGN)
    project.allow(allowed)
    catalogue = load_states(project.path)
    assert find_behaviour(catalogue, f"{allowed}:Yes").__name__ == "Yes"
    assert find_behaviour(catalogue, "py_trees.behaviours:Success").__name__ == "Success"
    for name in (f"{other}:Yes", "this:Zen"):
        with pytest.raises(ModuleNotAllowed):
            find_behaviour(catalogue, name)
    assert not is_imported(other)
    assert not is_imported("this")


def test_a_module_of_the_project_stands_in_for_no_library(project: ProjectFolder) -> None:
    """It is told when its name is taken."""
    (project.path / "colorsys.py").write_text(STATE, encoding="utf-8")
    project.allow("colorsys")
    broken = load_states(project.path).broken["colorsys"]
    assert "another module of this name is loaded from" in broken.message


class Point:
    """An entry point that loads what a test says."""

    def __init__(self, name: str, loads: object) -> None:
        self.name = name
        self.value = f"{name}_package:CATALOGUE"
        self.dist = None
        self._loads = loads

    def load(self) -> object:
        if isinstance(self._loads, BaseException):
            raise self._loads
        return self._loads


def offer(monkeypatch: pytest.MonkeyPatch, points: Sequence[object]) -> None:
    """Have these be the entry points of the installed packages."""

    def entry_points(*, group: str) -> Sequence[object]:
        return points if group == engine.registry.STATES else ()

    monkeypatch.setattr(engine.registry, "entry_points", entry_points)


def test_an_entry_point_that_fails_leaves_the_others_alone(monkeypatch: pytest.MonkeyPatch) -> None:
    """It is named to whoever looks for a state that is not there."""
    nod = load_states()["flow.Wait"]
    points = [
        Point("exits", SystemExit(1)),
        Point("odd", {"odd.State": int}),
        Point("good", {"good.Nod": nod}),
    ]
    offer(monkeypatch, points)
    catalogue = load_states()
    assert list(catalogue) == ["good.Nod"]
    with pytest.raises(RegistryError, match=r"loading `exits` raised SystemExit: 1.*odd\.State is not a subclass"):
        find_state(catalogue, "their.Nod")


def test_a_name_that_two_packages_offer_is_nobodys(monkeypatch: pytest.MonkeyPatch) -> None:
    states = load_states()
    one, two = states["flow.Wait"], states["flow.Log"]
    points = [Point("one", {"their.Nod": one, "their.Wait": one}), Point("two", {"their.Nod": two})]
    offer(monkeypatch, points)
    catalogue = load_states()
    assert list(catalogue) == ["their.Wait"]
    with pytest.raises(RegistryError, match=r"two packages provide the state their\.Nod"):
        find_state(catalogue, "their.Nod")


def test_who_names_a_module_at_the_command_line_wants_it(project: ProjectFolder) -> None:
    """What it raises is contained there too."""
    module, bad = project.module(), project.module("raise SystemExit(3)")
    sys.path.append(str(project.path))
    assert state_by_path(f"{module}:Nod").outcomes == ("done",)
    with pytest.raises(RegistryError, match="raised SystemExit: 3"):
        state_by_path(f"{bad}:Nod")
