"""A kind of tool is one folder and one line in a table: nothing else names it, and the engine names none."""

from __future__ import annotations

import re
import subprocess
import sys
from pathlib import Path

import pytest

from engine.document.nodes.node_kinds import NODE_KINDS
from robots.model import Mechanism
from robots.tool_kinds import TOOL_KINDS, load_mechanisms, tool_kinds

ROOT = Path(__file__).resolve().parents[2]
PACKAGES = ("engine", "states", "robots", "editor_web")
SUFFIXES = {".py", ".ts", ".tsx", ".json", ".yaml"}
TABLE = "robots/tool_kinds.py"
MAGNET = re.compile(r"magnet(?!ic)", re.IGNORECASE)
"""Parts may be `magnetic`, whatever attracts them."""
FOLDERS = ("robots/magnet/", "robots/tools/magnet/")
"""The kind, and the built-in model of that kind."""


def files(package: str) -> list[Path]:
    """Return the source files of a package, without what is built and installed."""
    found = (path for path in (ROOT / package).rglob("*") if path.suffix in SUFFIXES and path.is_file())
    return [path for path in found if not {"node_modules", "static"} & set(path.parts)]


def naming(package: str, pattern: re.Pattern[str]) -> set[str]:
    """Return the files of a package whose name or text matches."""
    return {
        path.relative_to(ROOT).as_posix()
        for path in files(package)
        if pattern.search(path.relative_to(ROOT).as_posix()) or pattern.search(path.read_text(encoding="utf-8"))
    }


def test_one_file_outside_its_folder_names_the_magnet() -> None:
    """The table; behaviors, tests and pages of the documentation name it as users do."""
    found = {file for package in PACKAGES for file in naming(package, MAGNET)}
    assert {file for file in found if not file.startswith(FOLDERS)} == {TABLE}
    assert any(file.startswith(FOLDERS[0]) for file in found)


@pytest.mark.parametrize("package", ["engine", "editor_web"])
def test_neither_the_engine_nor_the_page_names_a_mechanism(package: str) -> None:
    """They learn from the table what a `tool.yaml` may have; `parallel` is a kind of node too."""
    places = {tag: place for kind in tool_kinds().values() for tag, place in kind.mechanisms.items()}
    models = [place.partition(":")[2] for place in places.values()]
    names = [*models, *(f'"{tag}"' for tag in places.keys() - NODE_KINDS.keys())]
    assert naming(package, re.compile("|".join(names))) == set()


@pytest.mark.parametrize("name", TOOL_KINDS)
def test_a_kind_in_the_table_has_the_name_of_its_line(name: str) -> None:
    assert tool_kinds()[name].name == name


def test_a_mechanism_is_listed_under_its_tag() -> None:
    """Which the document gives as `kind`, and the check needs before it loads the model."""
    listed = [tag for kind in tool_kinds().values() for tag in kind.mechanisms]
    models = [model for model in load_mechanisms() if isinstance(model, type) and issubclass(model, Mechanism)]
    assert [model.__struct_config__.tag for model in models] == listed


def test_the_kinds_are_known_without_their_models() -> None:
    """The catalogue of states asks for them at every start."""
    script = "import sys, engine.registry as r; print('magnet.On' in r.load_states(), 'numpy' in sys.modules)"
    done = subprocess.run([sys.executable, "-c", script], cwd=ROOT, capture_output=True, text=True, check=True)
    assert done.stdout.split() == ["True", "False"]
