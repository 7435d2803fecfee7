"""The plan of the house: few files at the top of each package, rooms of a size, imports that run one way."""

from __future__ import annotations

import re
from collections import defaultdict
from collections.abc import Mapping
from functools import cache
from pathlib import Path

import pytest

from tests.house.source_file import source_file

ROOT = Path(__file__).resolve().parents[2]
PACKAGES = ("engine", "states", "robots", "editor_web")


@cache
def modules(package: str) -> Mapping[str, Path]:
    """Return the modules of a package by dotted name."""
    found: dict[str, Path] = {}
    for path in sorted((ROOT / package).rglob("*.py")):
        parts = path.relative_to(ROOT).with_suffix("").parts
        if "node_modules" not in parts:
            found[".".join(parts[:-1] if parts[-1] == "__init__" else parts)] = path
    return found


def imports(path: Path, known: Mapping[str, Path]) -> set[str]:
    """Return the modules of the same package that a file imports."""
    found: set[str] = set()
    for module, names, level in source_file(path).imports:
        if not level:
            found |= ({f"{module}.{name}" for name in names or ()} & known.keys()) or {module}
    return {name for name in found if name in known}


def room_of(module: str, path: Path) -> str:
    """Return the room of a module: its top folder in the package, or itself where it lies beside the rooms."""
    package, _, rest = module.partition(".")
    if path.name != "__init__.py" and "." not in rest:
        return module
    return f"{package}.{rest.partition('.')[0]}" if rest else module


def rooms(package: str) -> Mapping[str, set[str]]:
    """Return which rooms of a package each room imports."""
    known = modules(package)
    graph: dict[str, set[str]] = defaultdict(set)
    for module, path in known.items():
        own = room_of(module, path)
        graph[own] |= {room_of(other, known[other]) for other in imports(path, known)} - {own}
    return graph


def longest_chain(graph: Mapping[str, set[str]]) -> list[str]:
    """Return the longest chain of imports between rooms; fails where they run in a circle."""
    chains: dict[str, list[str]] = {}

    def chain(room: str, above: tuple[str, ...]) -> list[str]:
        assert room not in above, " → ".join((*above[above.index(room) :], room))
        if room not in chains:
            below = [chain(other, (*above, room)) for other in sorted(graph.get(room, ()))]
            chains[room] = [room, *max(below, key=len, default=list[str]())]
        return chains[room]

    return max((chain(room, ()) for room in sorted(graph)), key=len)


@pytest.mark.parametrize(("package", "floors"), [("engine", 12), ("robots", 8), ("editor_web", 10)])
def test_imports_between_rooms_run_one_way_over_few_floors(package: str, floors: int) -> None:
    """The longest chain of rooms that need one another."""
    chain = longest_chain(rooms(package))
    assert len(chain) <= floors, " → ".join(chain)


def page_floors(package: str) -> Mapping[str, int]:
    """Return the floor of each room, as the table of the package in `architecture.md` tells it."""
    page = (ROOT / "docs/concepts/architecture.md").read_text(encoding="utf-8")
    table = page.partition(f"### `{package}/`\n")[2].partition("\n#")[0]
    return {
        f"{package}.{name.removesuffix('/').removesuffix('.py')}": int(floor)
        for floor, names in re.findall(r"^\| (\d+) \| ([^|]+) \|", table, re.MULTILINE)
        for name in re.findall(r"`([^`]+)`", names)
    }


@pytest.mark.parametrize("package", ["engine", "robots", "editor_web"])
def test_each_room_stands_on_the_floor_that_the_page_of_the_architecture_tells(package: str) -> None:
    """The table has all rooms; a room uses rooms on lower floors only."""
    shown = page_floors(package)
    graph = {room: used - {package} for room, used in rooms(package).items() if room != package}
    assert sorted(graph.keys() - shown.keys()) == []
    odd = [
        f"{room} on floor {shown[room]} uses {other} on floor {shown[other]}"
        for room, used in sorted(graph.items())
        for other in sorted(used)
        if shown[other] >= shown[room]
    ]
    assert odd == []


@pytest.mark.parametrize(("folder", "most"), [("engine", 15), ("engine/sweep", 10), ("editor_web", 12), ("robots", 12)])
def test_few_files_lie_beside_the_rooms(folder: str, most: int) -> None:
    """A reader finds rooms, and the contracts that all of them share."""
    assert len(list((ROOT / folder).glob("*.py"))) <= most


@pytest.mark.parametrize(
    "folder", ["robots", "editor_web", "engine/check", "engine/cli", "engine/document", "engine/editing"]
)
def test_rooms_hold_at_most_twenty_files(folder: str) -> None:
    """Not counting `__init__`."""
    counts = {path: len(list(path.glob("*.py"))) - 1 for path in sorted((ROOT / folder).rglob("*")) if path.is_dir()}
    assert {str(path): count for path, count in counts.items() if count > 20} == {}


@pytest.mark.parametrize("package", PACKAGES)
def test_each_room_says_what_it_is_for(package: str) -> None:
    """In the docstring of its `__init__`."""
    faces = [path for path in modules(package).values() if path.name == "__init__.py"]
    assert [str(p) for p in faces if not source_file(p).docstring] == []
    folders = {path.parent for path in modules(package).values()}
    assert {folder for folder in folders if not (folder / "__init__.py").is_file()} == set()
