"""`${…}` in the text of a document: CEL expressions over parameters and userdata, never Python.

A text that is one expression has the typed value of the expression; expressions inside a longer text
are inserted as text. `$${` is a literal `${`.

An evaluation that may take more than `MAX_STEPS` is refused: its cost is bounded in advance from its syntax
and the sizes of its variables. Expressions are therefore evaluated in place, also on the event loop.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable, Iterator, Sequence
from typing import cast

import msgspec

from engine.document.expression.cel_expression import (
    MAX_TEXT,
    Expression,
    Variables,
    compile_expression,
    shorten_text,
    too_much_text,
)
from engine.document.expression.expression_cost import MAX_STEPS
from engine.document.expression.step_meter import METER
from engine.document.expression.value_size import SMALL, measure_value
from engine.errors import ExpressionError

MAX_PER_TEXT = 100
"""Maximum number of expressions in one text."""
MAX_PER_VALUE = 1_000
"""Maximum number of expressions in one value, including nested lists and mappings."""

_BEGIN = 30.0
"""Steps to start an evaluation with a counted cost."""
_LOOK = 1.5
"""Steps for each character of an expression with a counted cost."""
_MEASURE = 0.4
"""Steps for each measured unit of weight."""
_Evaluation = Callable[[Variables], object]

_PLAIN = frozenset((bool, int, float, type(None)))


class Template(msgspec.Struct, frozen=True, gc=False):
    """A value with expressions; `evaluate` replaces them."""

    value: object
    """The value as written in the document."""
    names: frozenset[str]
    """The variables that the expressions use."""
    _evaluate: _Evaluation | None
    _read: _Read

    @property
    def constant(self) -> bool:
        """True if it contains no expression."""
        return self._evaluate is None

    def evaluate(self, variables: Variables) -> object:
        """Return the value with its expressions replaced; without expressions, the value itself.

        Raises:
            ExpressionError: a variable is missing, an expression fails, or it may exceed the step limit.
        """
        if self._evaluate is None:
            return self.value
        if self._read.names:
            METER.spend(self._read.steps(variables))
        return self._evaluate(variables)


def compile_template(value: object) -> Template:
    """Compile the expressions in a document value: text, or lists and mappings that contain text.

    Raises:
        ExpressionError: an expression is malformed, or there are too many.
    """
    found: list[_Found] = []
    evaluation = _prepare(value, found)
    if not found and evaluation is None:
        return Template(value, _NO_NAMES, None, _NOTHING_READ)
    return Template(value, _names(expression for expression, _ in found), evaluation, _new_read(found))


def _names(expressions: Iterable[Expression], *more: str) -> frozenset[str]:
    """Return all names in the expressions, reusing the set of one of them if it holds all names."""
    sets = {frozenset(more), *(expression.names for expression in expressions)} - {frozenset[str]()}
    return sets.pop() if len(sets) == 1 else frozenset[str]().union(*sets)


_Found = tuple["Expression", bool]
"""An expression, and whether its value is inserted into a text."""


class _Read(msgspec.Struct, frozen=True, gc=False):
    """The variables that the expressions of a value read, which determine their cost."""

    computed: tuple[Expression, ...] = ()
    shown: tuple[str, ...] = ()
    """Variables whose values are inserted as text."""
    names: frozenset[str] = frozenset()
    small_steps: float | None = 0.0
    """The cost with small values; None if that may exceed the limit."""
    characters: int = 0

    def steps(self, variables: Variables) -> float:
        """Return an upper bound of the steps of an evaluation.

        Raises:
            ExpressionError: the bound exceeds the step limit.
        """
        if self.small_steps is not None and all(map(_is_small, map(variables.get, self.names))):
            return self.small_steps
        sizes = {name: measure_value(variables[name], name=name) for name in self.names if name in variables}
        METER.work(_BEGIN + _LOOK * self.characters + _MEASURE * sum(size.weight for size in sizes.values()))
        steps = 0.0
        for expression in self.computed:
            steps += expression.steps(sizes)
            if steps > MAX_STEPS:
                raise expression.too_long(steps)
        return steps + sum(sizes[name].weight for name in self.shown if name in sizes)


_NO_NAMES = frozenset[str]()
_NOTHING_READ = _Read()


def _new_read(found: list[_Found]) -> _Read:
    computed = tuple(expression for expression, _ in found if not expression.bare)
    shown = tuple(expression.text for expression, in_text in found if expression.bare and in_text)
    names = _names(computed, *shown)
    small = sum(expression.small_steps for expression in computed) + 2 * len(shown)
    characters = sum(len(expression.text) for expression in computed)
    return _Read(computed, shown, names, small if small <= MAX_STEPS else None, characters)


def _is_small(value: object) -> bool:
    """Return whether a value is within `SMALL`."""
    if _is_short(value):
        return True
    if isinstance(value, dict):
        known = cast("dict[object, object]", value)
        return len(known) <= SMALL.length and all(map(_is_short, known)) and all(map(_is_short, known.values()))
    if isinstance(value, list | tuple):
        items = cast("Collection[object]", value)
        return len(items) <= SMALL.length and all(map(_is_short, items))
    return False


def _is_short(value: object) -> bool:
    return type(value) in _PLAIN or (isinstance(value, str) and len(value) <= SMALL.text)


def _prepare(value: object, found: list[_Found]) -> _Evaluation | None:
    if isinstance(value, str):
        return _prepare_text(value, found) if "${" in value else None
    if isinstance(value, dict):
        return _prepare_mapping(cast("dict[str, object]", value), found)
    if isinstance(value, list | tuple):
        return _prepare_list(cast("list[object]", value), found)
    return None


def _prepare_mapping(mapping: dict[str, object], found: list[_Found]) -> _Evaluation | None:
    live = {key: ready for key, item in mapping.items() if (ready := _prepare(item, found)) is not None}
    return _Mapping(mapping, live) if live else None


def _prepare_list(items: list[object], found: list[_Found]) -> _Evaluation | None:
    live = {index: ready for index, item in enumerate(items) if (ready := _prepare(item, found)) is not None}
    return _List(items, live) if live else None


def _at(key: str, evaluate: _Evaluation, variables: Variables) -> object:
    try:
        return evaluate(variables)
    except ExpressionError as error:
        if error.where is None:
            error.where = f"`{key}`"
        raise


def _prepare_text(text: str, found: list[_Found]) -> _Evaluation:
    pieces = split_text(text)
    alone = len(pieces) == 1
    found += [(piece, not alone) for piece in pieces if isinstance(piece, Expression)]
    if len(found) > MAX_PER_VALUE:
        raise ExpressionError(f"more than {MAX_PER_VALUE} expressions in one value", hint="use a state instead")
    return _Alone(pieces[0]) if alone else _Joined(text, pieces)


class _Mapping(msgspec.Struct, frozen=True, gc=False):
    written: dict[str, object]
    live: dict[str, _Evaluation]

    def __call__(self, variables: Variables) -> object:
        live = self.live
        return {k: _at(k, live[k], variables) if k in live else item for k, item in self.written.items()}


class _List(msgspec.Struct, frozen=True, gc=False):
    written: Sequence[object]
    live: dict[int, _Evaluation]

    def __call__(self, variables: Variables) -> object:
        live = self.live
        return [live[i](variables) if i in live else item for i, item in enumerate(self.written)]


class _Alone(msgspec.Struct, frozen=True, gc=False):
    piece: str | Expression

    def __call__(self, variables: Variables) -> object:
        return self.piece if isinstance(self.piece, str) else self.piece.compute(variables)


class _Joined(msgspec.Struct, frozen=True, gc=False):
    text: str
    pieces: list[str | Expression]

    def __call__(self, variables: Variables) -> object:
        shown = (piece if isinstance(piece, str) else piece.text_of(variables) for piece in self.pieces)
        joined = "".join(shown)
        if len(joined) > MAX_TEXT:
            raise ExpressionError(
                f"`{shorten_text(self.text)}`: {too_much_text(len(joined))}", hint="use a state instead"
            )
        return joined


def split_text(text: str) -> list[str | Expression]:
    """Return the literal pieces and the expressions of a text in order.

    Raises:
        ExpressionError: an expression is malformed, or there are too many.
    """
    pieces: list[str | Expression] = []
    literal: list[str] = []
    index = 0
    for start in _openings(text):
        if start < index:
            continue
        if text.startswith("$${", start - 1) and start > index:
            literal.append(f"{text[index : start - 1]}${{")
            index = start + 2
            continue
        end = _closing_brace(text, start + 2)
        literal.append(text[index:start])
        pieces += ["".join(literal)] if any(literal) else []
        pieces.append(compile_expression(text[start + 2 : end]))
        if len(pieces) > 2 * MAX_PER_TEXT:
            raise ExpressionError(
                f"`{shorten_text(text)}`: more than {MAX_PER_TEXT} expressions", hint="use a state instead"
            )
        literal = []
        index = end + 1
    literal.append(text[index:])
    return [*pieces, "".join(literal)] if any(literal) or not pieces else pieces


def _openings(text: str) -> Iterator[int]:
    index = text.find("${")
    while index >= 0:
        yield index
        index = text.find("${", index + 1)


def _closing_brace(text: str, start: int) -> int:
    """Return the index of the closing brace of an expression, skipping nested braces and quotes."""
    depth = 0
    quote = ""
    index = start
    while index < len(text):
        character = text[index]
        if quote:
            if character == "\\":
                index += 1
            elif character == quote:
                quote = ""
        elif character in "'\"":
            quote = character
        elif character == "{":
            depth += 1
        elif character == "}":
            if depth == 0:
                return index
            depth -= 1
        index += 1
    raise ExpressionError(
        f"`{shorten_text(text)}`: `${{` is not closed", hint="add `}`, or write `$${` for the characters"
    )
