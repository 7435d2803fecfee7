"""Expressions and parameters as values that the type checker accepts in the place of what they stand for."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any, Generic, TypeVar, cast

from engine.authoring.source_location import calling_position
from engine.document.cel_expression import compile_expression
from engine.errors import ExpressionError, Position

T = TypeVar("T")


@dataclass(frozen=True, kw_only=True, eq=False)
class Param(Generic[T]):
    """A parameter: `.value` stands for it where a `T` is wanted, `f"{param}"` in the midst of text."""

    name: str
    keys: Mapping[str, object] = field(repr=False)
    """Its declaration under the keys of documents."""
    place: Position = field(repr=False)

    @property
    def value(self) -> T:
        """What a run gives for it; in the document the expression `${name}`."""
        return cast("T", str(self))

    def __str__(self) -> str:
        return f"${{{self.name}}}"


def expr(text: str) -> Any:
    """Return the expression `${text}` over parameters and userdata, for any place that takes a value.

    Raises:
        ExpressionError: it is not well formed; `where` is the place of this call.
    """
    where = calling_position()
    if "${" in text:
        raise ExpressionError(f"`{text}` has its own `${{`", where=where, hint="write what stands between the braces")
    try:
        compile_expression(text)
    except ExpressionError as error:
        raise ExpressionError(error.message, where=where, hint=error.hint) from error
    return f"${{{text}}}"
