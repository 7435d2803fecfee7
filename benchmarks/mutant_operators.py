"""Small mistakes put into Python source, one at a time: the mutants of a file."""

from __future__ import annotations

import ast
from collections.abc import Iterator
from copy import deepcopy
from dataclasses import dataclass
from pathlib import Path

COMPARISONS: dict[type[ast.cmpop], type[ast.cmpop]] = {
    ast.Lt: ast.LtE,
    ast.LtE: ast.Lt,
    ast.Gt: ast.GtE,
    ast.GtE: ast.Gt,
    ast.Eq: ast.NotEq,
    ast.NotEq: ast.Eq,
    ast.Is: ast.IsNot,
    ast.IsNot: ast.Is,
    ast.In: ast.NotIn,
    ast.NotIn: ast.In,
}
ARITHMETIC: dict[type[ast.operator], type[ast.operator]] = {
    ast.Add: ast.Sub,
    ast.Sub: ast.Add,
    ast.Mult: ast.Div,
    ast.Div: ast.Mult,
    ast.BitOr: ast.BitAnd,
    ast.BitAnd: ast.BitOr,
}
_Node = ast.expr | ast.stmt


@dataclass(frozen=True, kw_only=True)
class Mutant:
    """One mistake in the body of a function: its lines, and the text before and after."""

    file: Path
    number: int
    line: int
    last_line: int
    function: tuple[int, int]
    """First and last line of the function around it."""
    before: str
    after: str

    def __str__(self) -> str:
        """Return where it is and what it changes."""
        return f"{self.file}:{self.line}: {self.before} → {self.after}"


@dataclass(frozen=True)
class _Change:
    node: _Node
    after: _Node
    function: tuple[int, int]


def mutants_of(file: Path) -> list[Mutant]:
    """Return all mutants of a file, in the order of its text."""
    tree = ast.parse(file.read_text(encoding="utf-8"))
    return [
        Mutant(
            file=file,
            number=number,
            line=change.node.lineno,
            last_line=change.node.end_lineno or change.node.lineno,
            function=change.function,
            before=_shown(change.node),
            after=_shown(change.after),
        )
        for number, change in enumerate(_changes(tree))
    ]


def mutated(file: Path, number: int) -> ast.Module:
    """Return the source of a file with this mutant in it."""
    tree = ast.parse(file.read_text(encoding="utf-8"))
    change = list(_changes(tree))[number]
    _Replacement(change).visit(tree)
    return ast.fix_missing_locations(tree)


class _Replacement(ast.NodeTransformer):
    def __init__(self, change: _Change) -> None:
        self._change = change

    def visit(self, node: ast.AST) -> ast.AST:
        if node is self._change.node:
            return ast.copy_location(self._change.after, node)
        return self.generic_visit(node)


def _shown(node: _Node) -> str:
    text = " ".join(ast.unparse(node).split())
    return text if len(text) <= 90 else f"{text[:87]}..."


def _changes(tree: ast.Module) -> Iterator[_Change]:
    for node, function in _nodes(tree, None):
        for after in _mistakes(node):
            yield _Change(node, after, function)


def _nodes(parent: ast.AST, function: tuple[int, int] | None) -> Iterator[tuple[_Node, tuple[int, int]]]:
    """Yield what lies in bodies of functions, with the lines of the outermost; no annotations and no decorators."""
    for name, value in ast.iter_fields(parent):
        if name in ("annotation", "returns", "decorator_list"):
            continue
        inside = function
        if inside is None and isinstance(parent, ast.FunctionDef | ast.AsyncFunctionDef) and name == "body":
            inside = (parent.lineno, parent.end_lineno or parent.lineno)
        children: list[object] = list(value) if isinstance(value, list) else [value]  # pyright: ignore[reportUnknownArgumentType] # fields of a node have no types
        for child in children:
            if not isinstance(child, ast.AST) or isinstance(child, ast.Import | ast.ImportFrom | ast.arg):
                continue
            if inside is not None and isinstance(child, ast.expr | ast.stmt):
                yield child, inside
            yield from _nodes(child, inside)


def _mistakes(node: _Node) -> Iterator[_Node]:
    """Yield what may stand in place of a node."""
    match node:
        case ast.Compare(left=left, ops=[operator], comparators=comparators) if type(operator) in COMPARISONS:
            yield ast.Compare(left=left, ops=[COMPARISONS[type(operator)]()], comparators=comparators)
        case ast.BoolOp(op=operator, values=values):
            yield ast.BoolOp(op=ast.Or() if isinstance(operator, ast.And) else ast.And(), values=values)
        case ast.UnaryOp(op=ast.Not() | ast.USub(), operand=operand):
            yield deepcopy(operand)
        case ast.BinOp(left=left, op=operator, right=right) if type(operator) in ARITHMETIC:
            if not _is_type_or_text(left) and not _is_type_or_text(right):
                yield ast.BinOp(left=left, op=ARITHMETIC[type(operator)](), right=right)
        case ast.Constant(value=bool(value)):
            yield ast.Constant(value=not value)
        case ast.Constant(value=int(value) | float(value)):
            yield ast.Constant(value=value + 1)
        case ast.If(test=test, body=body, orelse=orelse):
            yield ast.If(test=ast.UnaryOp(op=ast.Not(), operand=test), body=body, orelse=orelse)
        case ast.While(test=test, body=body, orelse=orelse) if not isinstance(test, ast.Constant):
            yield ast.While(test=ast.UnaryOp(op=ast.Not(), operand=test), body=body, orelse=orelse)
        case ast.IfExp(test=test, body=body, orelse=orelse):
            yield ast.IfExp(test=test, body=orelse, orelse=body)
        case ast.Return(value=ast.expr() as value) if not _is_none_or_false(value):
            yield ast.Return(value=ast.Constant(value=None))
        case ast.Break():
            yield ast.Continue()
        case ast.Continue():
            yield ast.Break()
        case ast.Raise() | ast.AugAssign() | ast.Delete():
            yield ast.Pass()
        case ast.Expr(value=ast.Call() | ast.Await()) | ast.Assign(targets=[ast.Attribute() | ast.Subscript()]):
            yield ast.Pass()
        case _:
            return


def _is_none_or_false(node: ast.expr) -> bool:
    return isinstance(node, ast.Constant) and (node.value is None or node.value is False)


def _is_type_or_text(node: ast.expr) -> bool:
    """Whether an operand is of a union of types or a text, where another operator is an error at once."""
    if isinstance(node, ast.Constant):
        return node.value is None or isinstance(node.value, str)
    return isinstance(node, ast.JoinedStr | ast.List | ast.Tuple)
