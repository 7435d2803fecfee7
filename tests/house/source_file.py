"""What a Python file imports, defines and calls: each file is parsed once for all tests of the house."""

from __future__ import annotations

import ast
from collections import defaultdict
from collections.abc import Iterator
from functools import cache
from pathlib import Path
from typing import Any, NamedTuple, TypeVar

_Node = TypeVar("_Node", bound=ast.AST)


class Import(NamedTuple):
    """`import module`, or `from module import names` with the number of dots before the module."""

    module: str
    names: tuple[str, ...] | None
    level: int


class SourceFile(NamedTuple):
    """The facts about a file."""

    docstring: bool
    imports: tuple[Import, ...]
    classes: tuple[str, ...]
    """Those that are public and stand in no other class or function."""
    functions: tuple[str, ...]
    """All, with methods and those inside others."""
    assigned: frozenset[str]
    """Attributes, parameters, keyword arguments and locals, where the file assigns or passes them."""
    called: frozenset[str]
    """What is called by its name, or by a name and one attribute: `Run`, `Journal.open`."""


@cache
def source_file(path: Path) -> SourceFile:
    """Return the facts about a file."""
    return source_text(path.read_text(encoding="utf-8"))


def source_text(text: str) -> SourceFile:
    """Return the facts about the text of a file."""
    tree = ast.parse(text)
    found = _Nodes(tree)
    imports = [Import(each.name, None, 0) for node in found.of(ast.Import) for each in node.names]
    imports += [
        Import(node.module or "", tuple(each.name for each in node.names), node.level)
        for node in found.of(ast.ImportFrom)
    ]
    functions = [node.name for node in (*found.of(ast.FunctionDef), *found.of(ast.AsyncFunctionDef))]
    classes = (node.name for node in tree.body if isinstance(node, ast.ClassDef) and not node.name.startswith("_"))
    return SourceFile(
        docstring=bool(ast.get_docstring(tree)),
        imports=tuple(imports),
        classes=tuple(classes),
        functions=tuple(functions),
        assigned=frozenset(filter(None, _assigned(found))),
        called=frozenset(filter(None, (_name_of(call.func) for call in found.of(ast.Call)))),
    )


class _Nodes:
    """The nodes of a tree by their class: a million of them are not asked one by one what they are."""

    def __init__(self, tree: ast.AST) -> None:
        self._by_class: dict[type[ast.AST], list[Any]] = defaultdict(list)
        for node in ast.walk(tree):
            self._by_class[type(node)].append(node)

    def of(self, kind: type[_Node]) -> list[_Node]:
        """Return the nodes of a class."""
        return self._by_class[kind]


def _assigned(found: _Nodes) -> Iterator[str | None]:
    yield from (node.id for node in found.of(ast.Name) if isinstance(node.ctx, ast.Store))
    yield from (node.attr for node in found.of(ast.Attribute) if isinstance(node.ctx, ast.Store))
    yield from (node.arg for node in (*found.of(ast.arg), *found.of(ast.keyword)))
    yield from (node.asname for node in found.of(ast.alias))
    for kind in (ast.ExceptHandler, ast.MatchAs, ast.MatchStar):
        yield from (node.name for node in found.of(kind))


def _name_of(called: ast.expr) -> str | None:
    match called:
        case ast.Name(id=name):
            return name
        case ast.Attribute(value=ast.Name(id=owner), attr=name):
            return f"{owner}.{name}"
        case _:
            return None
