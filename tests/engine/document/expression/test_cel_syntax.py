"""The tree that is read is the one that CEL has parsed: names, calls, literals, macros as folds."""

from __future__ import annotations

import pytest

from engine.document.expression.cel_environment import environment
from engine.document.expression.cel_syntax import (
    CelCall,
    CelComprehension,
    CelIdentifier,
    CelLiteral,
    CelSelect,
    ParsedExpression,
    read_parsed,
)


def parsed(text: str) -> ParsedExpression:
    """Parse a text as expressions are parsed."""
    return read_parsed(environment().compile(text, disable_check=True).serialize())


def test_calls_selections_and_literals_are_read() -> None:
    """Operators are calls; text is kept, numbers are not."""
    root = parsed("a.b + 'é😀'").root
    assert isinstance(root, CelCall)
    assert root.function == "_+_"
    field, text = root.arguments
    assert isinstance(field, CelSelect)
    assert isinstance(field.operand, CelIdentifier)
    assert (field.operand.name, text) == ("a", CelLiteral("é😀"))


def test_a_macro_is_a_fold() -> None:
    """`map` goes over its list and adds one item a round."""
    root = parsed("xs.map(x, x * 2)").root
    assert isinstance(root, CelComprehension)
    assert root.variable == "x"
    assert isinstance(root.step, CelCall)
    assert root.step.function == "_+_"


@pytest.mark.parametrize(
    ("text", "names"),
    [
        ("x.map(x, x + y)", [("x", 0), ("y", 13)]),
        ("'é😀' + a", [("a", 7)]),
        ("a.exists(b, b in a) && has(b.c)", [("a", 0), ("a", 17), ("b", 27)]),
        ("{'k': a}[b]", [("a", 6), ("b", 9)]),
        ("1 + 2", []),
    ],
)
def test_free_names_stand_where_they_stand_in_the_text(text: str, names: list[tuple[str, int]]) -> None:
    """A name that a macro binds is free outside of it only."""
    assert sorted(parsed(text).free_names(), key=lambda use: use[1]) == names
