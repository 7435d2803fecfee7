"""Expressions and parameters as values that type checkers accept in place of their results."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any, Generic, TypeVar, cast

from engine.authoring.source_location import calling_position
from engine.document.expression.cel_expression import compile_expression
from engine.errors import ExpressionError, Position

T = TypeVar("T")


@dataclass(frozen=True, kw_only=True, eq=False)
class Param(Generic[T]):
    """A parameter: use `.value` where a `T` is expected, `f"{param}"` inside text."""

    name: str
    keys: Mapping[str, object] = field(repr=False)
    """Its declaration with document keys."""
    place: Position = field(repr=False)

    @property
    def value(self) -> T:
        """The value in a run; in the document the expression `${name}`."""
        return cast("T", str(self))

    def __str__(self) -> str:
        return f"${{{self.name}}}"


def expr(text: str) -> Any:
    """Return the expression `${text}` over parameters and userdata, for any place that accepts a value.

    Raises:
        ExpressionError: it is malformed; `where` is the position of this call.
    """
    where = calling_position()
    if "${" in text:
        raise ExpressionError(f"`{text}` contains `${{`", where=where, hint="write only the text between the braces")
    try:
        compile_expression(text)
    except ExpressionError as error:
        raise ExpressionError(error.message, where=where, hint=error.hint) from error
    return f"${{{text}}}"
