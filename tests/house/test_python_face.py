"""`from engine import …` and lazy faces of rooms: the same names for checkers as at run time; cheap, and no circle."""

from __future__ import annotations

import ast
import os
import subprocess
import sys
from importlib import import_module
from pathlib import Path
from types import ModuleType

import pytest

import engine
from engine.lazy_face import lazy_face

ROOT = Path(__file__).resolve().parents[2]
LAZY_FACES = [
    ".".join(path.parent.relative_to(ROOT).parts)
    for path in sorted((ROOT / "engine").rglob("__init__.py"))
    if "lazy_face(" in path.read_text(encoding="utf-8")
]


def _stub_tree(face: str) -> ast.Module:
    return ast.parse((ROOT / face.replace(".", "/") / "__init__.pyi").read_text(encoding="utf-8"))


def _stub(face: str) -> dict[str, str]:
    """The names of the stub, each with the module it comes from."""
    imports = [node for node in _stub_tree(face).body if isinstance(node, ast.ImportFrom) and node.module is not None]
    return {alias.name: str(node.module) for node in imports for alias in node.names}


def _stub_exports(face: str) -> list[str]:
    (exports,) = (node.value for node in _stub_tree(face).body if isinstance(node, ast.Assign))
    found: list[str] = ast.literal_eval(exports)
    return found


@pytest.mark.parametrize("face", LAZY_FACES)
def test_type_checkers_see_the_names_that_can_be_imported(face: str) -> None:
    names = import_module(face).__all__
    assert _stub_exports(face) == names
    assert set(_stub(face)) == set(names)


@pytest.mark.parametrize("face", LAZY_FACES)
def test_names_are_what_their_stub_says(face: str) -> None:
    module = import_module(face)
    stub = _stub(face)
    assert stub
    assert [n for n, home in stub.items() if getattr(module, n) is not getattr(import_module(home), n)] == []


@pytest.mark.parametrize("face", LAZY_FACES)
def test_no_module_of_a_room_takes_the_place_of_a_name(face: str) -> None:
    """A module becomes an attribute of its package when it is loaded, by whomever."""
    folder = ROOT / face.replace(".", "/")
    modules = {path.stem for path in folder.iterdir() if path.suffix == ".py" or path.is_dir()}
    assert modules & set(_stub(face)) == set()


def test_a_lazy_name_is_looked_up_once() -> None:
    package = ModuleType("engine_of_this_test")
    with pytest.MonkeyPatch.context() as patch:
        patch.setitem(sys.modules, package.__name__, package)
        assert lazy_face(package.__name__, {"Path": "pathlib"})("Path") is Path
        assert vars(package)["Path"] is Path


def test_another_name_is_refused_as_by_every_module() -> None:
    with pytest.raises(ImportError, match="cannot import name 'Porject' from 'engine'"):
        exec("from engine import Porject")


@pytest.mark.parametrize(
    ("statement", "spared"),
    [
        ("import engine", ("msgspec", "asyncio", "engine.state", "engine.runtime", "engine.project")),
        ("from engine import State, Outcome, Context", ("engine.runtime", "engine.project", "engine.bus")),
        ("from engine import SkillBus, run_virtual", ("engine.runtime", "engine.project", "engine.journal")),
        ("from engine.project import RunOperator", ("engine.project.session", "engine.bus", "engine.runtime.run")),
        ("from engine.cell import RobotModels", ("engine.cell.open_cell", "engine.store")),
        ("from engine.runtime import decode_nonfinite", ("engine.runtime.run", "engine.bus", "engine.document")),
        ("from engine.runtime.history import ScopeView", ("engine.runtime.history.resume", "engine.runtime.run")),
    ],
)  # fmt: skip
def test_a_name_loads_only_its_own_room(statement: str, spared: tuple[str, ...]) -> None:
    """A state file does not load what executes it."""
    command = [sys.executable, "-P", "-c", f"{statement}\nimport sys\nprint(*sys.modules)"]
    environment = {**os.environ, "PYTHONPATH": str(ROOT)}
    loaded = subprocess.run(command, env=environment, capture_output=True, text=True, check=True).stdout.split()
    assert sorted(set(spared) & set(loaded)) == []


def test_the_packages_do_not_import_their_own_face() -> None:
    """The engine would import itself in a circle; the wings say from which room they take a name."""
    found: list[str] = []
    for package in ("engine", "states", "robots", "editor_web"):
        for path in (ROOT / package).rglob("*.py"):
            text = path.read_text(encoding="utf-8") if "node_modules" not in path.parts else ""
            if "from engine import" not in text:
                continue
            names = {
                alias.name
                for node in ast.walk(ast.parse(text))
                if isinstance(node, ast.ImportFrom) and node.module == "engine" and node.level == 0
                for alias in node.names
            }
            if names & set(engine.__all__):
                found.append(str(path))
    assert found == []
