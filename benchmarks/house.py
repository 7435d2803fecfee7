"""Figures of how the code is arranged: rooms, floors, names, copies, and what a new decorator touches.

    python -m benchmarks.house [FOLDER ...]

Each folder is a checkout; without one it is this one. Two of them stand side by side: `git worktree add ../before
COMMIT` and `python -m benchmarks.house ../before .` compare two commits. Nothing of a checkout is imported.
"""

from __future__ import annotations

import argparse
import ast
import re
from collections import Counter, defaultdict
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from functools import cache
from pathlib import Path

PACKAGES = ("engine", "states", "robots", "editor_web")
WINGS = ("states", "robots", "editor_web")
HERE = Path(__file__).resolve().parents[1]
TAGS_OF_NODES = frozenset({"entered", "exited", "transition"})
LEAST_FIELDS, MOST_SHARED = 3, 0.75


@dataclass(frozen=True)
class Module:
    """One Python file of a package: its dotted name, and its syntax."""

    name: str
    path: Path
    text: str
    tree: ast.Module

    @property
    def is_package(self) -> bool:
        """Whether this is the `__init__` of a folder."""
        return self.path.name == "__init__.py"

    @property
    def room(self) -> str:
        """Its top folder in the package, or itself where it lies beside the rooms."""
        package, _, rest = self.name.partition(".")
        if not self.is_package and "." not in rest:
            return self.name
        return f"{package}.{rest.partition('.')[0]}" if rest else self.name


@cache
def modules(root: Path, package: str) -> Mapping[str, Module]:
    """Return the modules of a package by dotted name."""
    found: dict[str, Module] = {}
    for path in sorted((root / package).rglob("*.py")):
        parts = path.relative_to(root).with_suffix("").parts
        if "node_modules" in parts:
            continue
        name = ".".join(parts[:-1] if parts[-1] == "__init__" else parts)
        text = path.read_text(encoding="utf-8")
        found[name] = Module(name, path, text, ast.parse(text))
    return found


def imported(module: Module, known: Mapping[str, Module]) -> set[str]:
    """Return the modules among `known` that a module imports."""
    found: set[str] = set()
    for node in ast.walk(module.tree):
        if isinstance(node, ast.Import):
            found |= {alias.name for alias in node.names}
        elif isinstance(node, ast.ImportFrom) and node.module and not node.level:
            names = {f"{node.module}.{alias.name}" for alias in node.names}
            found |= (names & known.keys()) or {node.module}
    return {name for name in found if name in known}


def floors(root: Path, package: str) -> int:
    """Return the length of the longest chain of imports between rooms; a circle ends a chain."""
    known = modules(root, package)
    graph: dict[str, set[str]] = defaultdict(set)
    for module in known.values():
        graph[module.room] |= {known[other].room for other in imported(module, known)} - {module.room}
    lengths: dict[str, int] = {}

    def length(room: str, above: frozenset[str]) -> int:
        if room not in lengths:
            below = [length(other, above | {room}) for other in graph.get(room, ()) if other not in above]
            lengths[room] = 1 + max(below, default=0)
        return lengths[room]

    return max((length(room, frozenset()) for room in sorted(graph)), default=0)


def files_beside_rooms(root: Path, package: str) -> int:
    """Return the number of files at the top of a package."""
    return len(list((root / package).glob("*.py")))


def largest_folder(root: Path, folder: str) -> int:
    """Return the greatest number of files in one folder below `folder`, without `__init__`."""
    counts = Counter(path.parent for path in (root / folder).rglob("*.py") if path.name != "__init__.py")
    return max((count for path, count in counts.items() if "node_modules" not in path.parts), default=0)


def repeated_class_names(root: Path) -> int:
    """Return how many public class names stand for several classes; a state shares the name of its skill."""
    places: dict[str, set[str]] = defaultdict(set)
    for package in PACKAGES:
        for module in modules(root, package).values():
            for node in module.tree.body:
                if isinstance(node, ast.ClassDef) and not node.name.startswith("_"):
                    is_request = module.name.startswith(("states.", "engine.skills."))
                    places[node.name].add("skill and state" if is_request else module.name)
    return sum(len(found) > 1 for found in places.values())


def fields_of(node: ast.ClassDef) -> frozenset[str]:
    """Return the names of the fields of a class: annotated ones, and properties of a protocol."""
    annotated = {
        each.target.id for each in node.body if isinstance(each, ast.AnnAssign) and isinstance(each.target, ast.Name)
    }
    is_protocol = any(isinstance(base, ast.Name) and base.id == "Protocol" for base in node.bases)
    properties = {each.name for each in node.body if isinstance(each, ast.FunctionDef) and is_property(each)}
    return frozenset(annotated | (properties if is_protocol else set()))


def is_property(node: ast.FunctionDef) -> bool:
    """Return whether a method is a property."""
    return any(isinstance(each, ast.Name) and each.id == "property" for each in node.decorator_list)


def classes(root: Path, package: str) -> Iterator[tuple[str, frozenset[str]]]:
    """Yield the public classes of a package with enough fields to compare."""
    for module in modules(root, package).values():
        for node in module.tree.body:
            if isinstance(node, ast.ClassDef) and not node.name.startswith("_"):
                fields = fields_of(node)
                if len(fields) >= LEAST_FIELDS:
                    yield node.name, fields


def mirrors(root: Path) -> int:
    """Return how many classes of the server repeat three quarters of the fields of a class of the engine."""
    facts = [fields for _, fields in classes(root, "engine")]
    return sum(
        any(len(fields & fact) >= MOST_SHARED * max(len(fields), len(fact)) for fact in facts)
        for _, fields in classes(root, "editor_web")
    )


def folds(root: Path) -> int:
    """Return how many files tell the events of nodes apart: by `isinstance`, or in a `match`."""
    events = events_of_nodes(root)
    found: set[Path] = set()
    for package in ("engine", "editor_web"):
        for module in modules(root, package).values():
            for node in ast.walk(module.tree):
                if events & tested_classes(node):
                    found.add(module.path)
    return len(found)


def events_of_nodes(root: Path) -> set[str]:
    """Return the classes of the events that a node was entered, has ended, and led to another; by their tags."""
    declared = modules(root, "engine")["engine.event"].tree.body
    return {
        node.name
        for node in declared
        if isinstance(node, ast.ClassDef)
        for keyword in node.keywords
        if keyword.arg == "tag" and isinstance(keyword.value, ast.Constant) and keyword.value.value in TAGS_OF_NODES
    }


def tested_classes(node: ast.AST) -> set[str]:
    """Return the names of classes that a piece of syntax tests a value against."""
    if isinstance(node, ast.MatchClass):
        return names_in(node.cls)
    if isinstance(node, ast.Call) and isinstance(node.func, ast.Name) and node.func.id == "isinstance":
        return names_in(node.args[-1])
    return set()


def names_in(node: ast.AST) -> set[str]:
    """Return the names that an expression uses."""
    nodes = list(ast.walk(node))
    plain = {each.id for each in nodes if isinstance(each, ast.Name)}
    return plain | {each.attr for each in nodes if isinstance(each, ast.Attribute)}


def files_that_name(root: Path, word: str) -> int:
    """Return how many files of the engine and the page contain a word, in names too; generated ones do not count."""
    pattern = re.compile(rf"(?i:{word})")
    page = root / "editor_web" / "frontend" / "src"
    files = [*(root / "engine").rglob("*.py"), *page.rglob("*.ts"), *page.rglob("*.tsx")]
    return sum(bool(pattern.search(path.read_text(encoding="utf-8"))) for path in files if path.name != "types.ts")


def inner_modules(root: Path) -> int:
    """Return how many modules inside a room of the engine the other packages import."""
    known = modules(root, "engine")
    found: set[str] = set()
    for wing in WINGS:
        for module in modules(root, wing).values():
            found |= {name for name in imported(module, known) if name.count(".") >= 2 and not known[name].is_package}
    return len(found)


def stamps(root: Path) -> int:
    """Return at how many places an event gets its number by hand."""
    return sum(module.text.count("seq=recorder.next_seq()") for module in modules(root, "engine").values())


def retired_words(root: Path) -> int:
    """Return how many names of files and classes contain a word that the glossary of this checkout lists as retired."""
    glossary = (HERE / "docs" / "reference" / "glossary.md").read_text(encoding="utf-8")
    retired = set(re.findall(r"^\| `(\w+)` \|", glossary.partition("## Retired words")[2], re.MULTILINE))
    names = [
        name
        for package in PACKAGES
        for module in modules(root, package).values()
        for name in (module.path.stem, *(node.name for node in module.tree.body if isinstance(node, ast.ClassDef)))
    ]
    words = ({word.lower() for word in re.findall(r"[A-Z]+(?![a-z])|[A-Z]?[a-z0-9]+", name)} for name in names)
    return sum(bool(found & retired) for found in words)


def lines(root: Path) -> int:
    """Return the lines of Python and TypeScript without tests, benchmarks and generated files."""
    page = root / "editor_web" / "frontend" / "src"
    files = [path for package in PACKAGES for path in (root / package).rglob("*.py")]
    files += [path for end in ("*.ts", "*.tsx") for path in page.rglob(end)]
    ours = (path for path in files if "node_modules" not in path.parts and ".test." not in path.name)
    return sum(len(path.read_text(encoding="utf-8").splitlines()) for path in ours if path.name != "types.ts")


FIGURES: Mapping[str, Callable[[Path], int]] = {
    "files beside the rooms of `engine/`": lambda root: files_beside_rooms(root, "engine"),
    "files beside the rooms of `editor_web/`": lambda root: files_beside_rooms(root, "editor_web"),
    "floors inside `engine/`": lambda root: floors(root, "engine"),
    "floors inside `robots/`": lambda root: floors(root, "robots"),
    "floors inside `editor_web/`": lambda root: floors(root, "editor_web"),
    "files in the largest folder of `engine/`": lambda root: largest_folder(root, "engine"),
    "files in the largest folder of `robots/`": lambda root: largest_folder(root, "robots"),
    "files in the largest folder of `editor_web/`": lambda root: largest_folder(root, "editor_web"),
    "public class names with several meanings": repeated_class_names,
    "retired words in names of files and classes": retired_words,
    "classes of the server that repeat one of the engine": mirrors,
    "files that tell the events of nodes apart": folds,
    "files that name the decorator `cooldown`": lambda root: files_that_name(root, "cooldown"),
    "modules inside rooms of the engine that others import": inner_modules,
    "events that are numbered by hand": stamps,
    "lines of code without tests": lines,
}


def main() -> None:
    """Print the figures of each folder as a table."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folders", nargs="*", type=Path, help="checkouts to compare (default: this one)")
    roots = [folder.resolve() for folder in parser.parse_args().folders] or [HERE]
    for root in roots:
        if not (root / "engine").is_dir():
            parser.error(f"{root} is no checkout of flexcell: it has no folder engine/")
    print("| figure |", " | ".join(root.name for root in roots), "|")
    print("|---|" + "---|" * len(roots))
    for what, figure in FIGURES.items():
        print(f"| {what} |", " | ".join(f"{figure(root):,}" for root in roots), "|")


if __name__ == "__main__":
    main()
