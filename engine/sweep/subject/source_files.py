"""The Python files that a state needs: that of its class, and the modules of its project that it imports.

Found in the text of the files, without executing any: an import inside a function counts like one at the top. What is
imported of other packages is not followed: their versions tell them apart. A name that is computed while a state runs
(`importlib.import_module`) is not seen.
"""

from __future__ import annotations

import ast
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from pathlib import Path

_OWN = frozenset({"engine", "states", "robots", "editor_web"})
"""The packages of this distribution, which has a version."""


@dataclass(frozen=True)
class SourceFile:
    """A Python file with its name as a module."""

    module: str
    """With dots, for example `my_cell.settle`."""
    file: Path
    """Resolved."""

    @property
    def root(self) -> Path:
        """The folder from which its name leads to it."""
        depth = self.module.count(".") + (self.file.name == "__init__.py")
        return self.file.parents[depth]

    @property
    def package(self) -> str:
        """The package that `from . import …` in it means."""
        return self.module if self.file.name == "__init__.py" else self.module.rpartition(".")[0]


def with_imports(start: Iterable[SourceFile], projects: Iterable[Path]) -> set[Path]:
    """Return files with all that they import, directly or not.

    A file in one of the folders `projects` may import all that is found by its name from there. Of another file, which
    is in an installed package, only the modules of the same package are followed.

    Args:
        start: The first files.
        projects: Folders whose modules can be imported, resolved.
    """
    folders = tuple(projects)
    found: dict[Path, SourceFile] = {}
    left = list(start)
    while left:
        source = left.pop()
        if source.file in found:
            continue
        found[source.file] = source
        own = source.module.partition(".")[0]
        inside = source.root in folders
        for name in _imported(source):
            package = name.partition(".")[0]
            if package not in _OWN and (inside or package == own):
                left += _located(name, (source.root, *folders) if inside else (source.root,))
    return set(found)


def _imported(source: SourceFile) -> Iterator[str]:
    """Yield the names that a file may import: also those that turn out to be names in a module."""
    try:
        tree = ast.parse(source.file.read_bytes())
    except (OSError, SyntaxError, ValueError):
        # It is loaded elsewhere, where its mistake is told.
        return
    for node in ast.walk(tree):
        if isinstance(node, ast.Import):
            yield from (alias.name for alias in node.names)
        elif isinstance(node, ast.ImportFrom):
            module = ".".join(filter(None, (_above(source.package, node.level), node.module)))
            yield module
            yield from (f"{module}.{alias.name}" for alias in node.names)


def _above(package: str, level: int) -> str:
    """Return the package that the dots of a relative import mean; empty for an absolute one."""
    return ".".join(package.split(".")[: package.count(".") + 2 - level]) if level else ""


def _located(name: str, folders: Iterable[Path]) -> Iterator[SourceFile]:
    """Yield the module of a name and the packages around it, where they are files below one of the folders."""
    steps = name.split(".")
    for folder in folders:
        for count in range(1, len(steps) + 1):
            path = folder.joinpath(*steps[:count])
            for file in (path / "__init__.py", path.with_suffix(".py")):
                if file.is_file():
                    yield SourceFile(".".join(steps[:count]), file)
                    break
