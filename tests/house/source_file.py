"""What a Python file imports, defines and calls: each file is parsed once for all tests of the house."""

from __future__ import annotations

import ast
from functools import cache
from pathlib import Path
from typing import NamedTuple


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
    imports: list[Import] = []
    functions: list[str] = []
    called: set[str] = set()
    for node in ast.walk(tree):
        match node:
            case ast.Import(names=modules):
                imports += (Import(each.name, None, 0) for each in modules)
            case ast.ImportFrom(module=module, names=names, level=level):
                imports.append(Import(module or "", tuple(each.name for each in names), level))
            case ast.FunctionDef(name=name) | ast.AsyncFunctionDef(name=name):
                functions.append(name)
            case ast.Call(func=ast.Name(id=name)):
                called.add(name)
            case ast.Call(func=ast.Attribute(value=ast.Name(id=owner), attr=name)):
                called.add(f"{owner}.{name}")
            case _:
                pass
    classes = (node.name for node in tree.body if isinstance(node, ast.ClassDef) and not node.name.startswith("_"))
    return SourceFile(
        docstring=bool(ast.get_docstring(tree)),
        imports=tuple(imports),
        classes=tuple(classes),
        functions=tuple(functions),
        assigned=frozenset(filter(None, map(_assigned, ast.walk(tree)))),
        called=frozenset(called),
    )


def _assigned(node: ast.AST) -> str | None:
    match node:
        case ast.Name(id=name, ctx=ast.Store()) | ast.Attribute(attr=name, ctx=ast.Store()):
            return name
        case ast.arg(arg=name) | ast.keyword(arg=name) | ast.alias(asname=name):
            return name
        case ast.ExceptHandler(name=name) | ast.MatchAs(name=name) | ast.MatchStar(name=name):
            return name
        case _:
            return None
