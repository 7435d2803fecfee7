"""`from engine import …`: the same names at run time, for type checkers and in the reference; cheap, and no circle."""

from __future__ import annotations

import ast
import os
import subprocess
import sys
from importlib import import_module
from pathlib import Path

import pytest

import engine

ROOT = Path(__file__).resolve().parents[2]


def _stub() -> dict[str, str]:
    """The names of the stub, each with the module it comes from."""
    tree = ast.parse((ROOT / "engine" / "__init__.pyi").read_text(encoding="utf-8"))
    imports = [node for node in tree.body if isinstance(node, ast.ImportFrom) and node.module is not None]
    return {alias.name: str(node.module) for node in imports for alias in node.names}


def _stub_exports() -> list[str]:
    tree = ast.parse((ROOT / "engine" / "__init__.pyi").read_text(encoding="utf-8"))
    (exports,) = (node.value for node in tree.body if isinstance(node, ast.Assign))
    found: list[str] = ast.literal_eval(exports)
    return found


def test_type_checkers_see_the_names_that_can_be_imported() -> None:
    assert _stub_exports() == engine.__all__
    assert set(_stub()) == set(engine.__all__)


@pytest.mark.parametrize("name", engine.__all__)
def test_a_name_is_what_its_stub_says(name: str) -> None:
    assert getattr(engine, name) is getattr(import_module(_stub()[name]), name)


def test_another_name_is_refused_as_by_every_module() -> None:
    with pytest.raises(ImportError, match="cannot import name 'Porject' from 'engine'"):
        exec("from engine import Porject")


@pytest.mark.parametrize(
    ("statement", "spared"),
    [
        ("import engine", ("msgspec", "asyncio", "engine.state", "engine.runtime", "engine.project")),
        ("from engine import State, Outcome, Context", ("engine.runtime", "engine.project", "engine.bus")),
        ("from engine import SkillBus, run_virtual", ("engine.runtime", "engine.project", "engine.journal")),
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
