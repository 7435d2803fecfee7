"""One expression of a document: compiled by CEL once, with its cost bounded before each evaluation.

Arithmetic accepts mixed integers and decimals: two integers give an integer (`7 / 2` is 3), else
the result is a decimal.
"""

from __future__ import annotations

import math
import re
from collections.abc import Mapping, Sized
from typing import Any, cast

import msgspec

from engine.document.expression.cel_environment import (
    ALIAS,
    MAX_NAMES,
    NameUse,
    ValueType,
    alias,
    aliased,
    environment,
    error_type,
    word_for,
)
from engine.document.expression.cel_syntax import ParsedExpression, Syntax, read_parsed
from engine.document.expression.expression_cost import MAX_STEPS, Sizes, cost_of
from engine.document.expression.text_cache import TextCache
from engine.document.expression.value_size import SCALAR, SMALL, measure_value
from engine.errors import ExpressionError

MAX_LENGTH = 1_000
MAX_TEXT = 100_000
"""Maximum number of characters in the result of an expression or of a text with expressions."""
MAX_RESULT_WEIGHT = 10_000
"""Maximum number of values in a list or mapping that an expression returns."""
RESERVED = frozenset(
    {
        *("as", "break", "const", "continue", "else", "for", "function", "if", "import", "in", "let", "loop"),
        *("namespace", "package", "return", "var", "void", "while", "true", "false", "null"),
        *("bool", "bytes", "double", "dyn", "int", "list", "map", "null_type", "string", "type", "uint"),
    }
)
"""Reserved words of the expression language; not allowed as names of parameters or userdata keys."""

Variables = Mapping[str, object]
_NAME = re.compile(r"[A-Za-z_][A-Za-z0-9_]*")
_UNDECLARED = re.compile(r"undeclared reference to '([^']*)'")
_ERROR_LINE = re.compile(r"ERROR: <input>:(-?\d+):(-?\d+): (.*)")
_ERROR_STATUS = re.compile(r"^[A-Z_]+: ")
_NO_OVERLOAD = re.compile(r"found no matching overload for '([^']*)' applied to '\((.*)\)'")
_NO_FIELDS = re.compile(r"expression of type '([^']*)' cannot be the operand of a select operation")
_SYMBOL = re.compile(r"^@?_?|_$")
_STRICT = frozenset(
    {
        *("_+_", "_-_", "_*_", "_/_", "_<_", "_<=_", "_>_", "_>=_", "!_", "-_", "_&&_", "_||_"),
        *("size", "startsWith", "endsWith", "contains", "matches"),
    }
)
"""Operations that fail at run time with wrong types; others, such as comparisons, fail only the type check."""
_MIXED_NUMBERS = re.compile(r"found no matching overload for .* applied to '\(.*\b(?:int.*double|double.*int)\b.*\)'")


def as_text(value: object) -> str:
    """Return a value as inserted into text: text unchanged, everything else as JSON."""
    return value if isinstance(value, str) else msgspec.json.encode(value).decode()


class Expression(msgspec.Struct, frozen=True, gc=False):
    """One compiled expression and the variables it uses."""

    text: str
    names: frozenset[str]
    small_steps: float
    """The cost with small values of all variables."""
    _program: Any  # cel.Expression; None if the expression is only the name of a variable
    _syntax: Syntax | None
    _uses: tuple[NameUse, ...]
    _aliases: Mapping[str, str]

    @property
    def bare(self) -> bool:
        """True if the expression is only the name of a variable."""
        return self._program is None

    def result_type(self, variables: Mapping[str, ValueType]) -> ValueType:
        """Return the static type of the result for these variable types.

        Raises:
            ExpressionError: the expression always fails with these types; names the operation.
        """
        if self.bare:
            return variables.get(self.text, "anything")
        names = enumerate(self._aliases)
        aliases = {name: alias(number, variables.get(name, "anything")) for number, name in names}
        return _result_type(self.text, aliased(self.text, self._uses, aliases))

    def steps(self, sizes: Sizes) -> float:
        """Return an upper bound of the evaluation steps with variables of these sizes.

        Raises:
            ExpressionError: the cost is unknown.
        """
        if self._syntax is None:
            return 0.0
        try:
            return cost_of(self._syntax, {name: sizes[name] for name in self.names if name in sizes}).steps
        except ExpressionError as error:
            raise ExpressionError(f"`${{{shorten_text(self.text)}}}`: {error.message}", hint=error.hint) from None

    def too_long(self, steps: float) -> ExpressionError:
        """Return the error for an evaluation that exceeds the step limit."""
        count = f"{steps:,.0f}" if steps < 1e12 else "unlimited"
        message = f"`${{{shorten_text(self.text)}}}`: this may take {count} steps with values of this size"
        hint = f"{MAX_STEPS:,.0f} are allowed; use smaller values, a simpler expression or a state"
        return ExpressionError(message, hint=hint)

    def compute(self, variables: Variables) -> object:
        """Return the value of the expression; the caller has checked its cost."""
        if self._program is None:
            return self._variable(variables, self.text)
        values = {name: self._variable(variables, name) for name in self.names}
        try:
            data = {called: _plain(values[name]) for name, called in self._aliases.items()}
            result = self._program.eval(data=data)
        except (RuntimeError, ValueError, TypeError, OverflowError) as error:
            raise self._failed(_ERROR_STATUS.sub("", str(error)), values) from error
        if result.type() == error_type():
            raise self._failed(_ERROR_STATUS.sub("", str(result.value())), values)
        return self._checked(result.plain_value(), values)

    def text_of(self, variables: Variables) -> str:
        """Return its value as inserted into text."""
        value = self.compute(variables)
        try:
            return as_text(value)
        except (TypeError, ValueError, OverflowError, RecursionError) as error:
            raise self._failed(str(error), {}) from error

    def _variable(self, variables: Variables, name: str) -> object:
        if name not in variables:
            raise ExpressionError(
                f"`${{{self.text}}}`: `{name}` is not defined", hint="it is not a parameter or userdata key"
            )
        return variables[name]

    def _checked(self, value: object, data: Variables) -> object:
        if isinstance(value, float) and not math.isfinite(value):
            raise self._failed(f"the result is {value}", data)
        if value is not None and not isinstance(value, bool | int | float | str | list | dict):
            raise self._failed(f"the result is a {type(value).__name__}, which is not a document value", data)
        if isinstance(value, str) and len(value) > MAX_TEXT:
            raise self._failed(too_much_text(len(value)), data)
        if isinstance(value, list | dict):
            self._check_size(cast("object", value), data)
        return cast("object", value)

    def _check_size(self, value: object, data: Variables) -> None:
        try:
            weight = measure_value(value, name="the result").weight
        except ExpressionError as error:
            raise self._failed(error.message, data) from None
        if weight > MAX_RESULT_WEIGHT:
            raise self._failed(f"the result contains more than {MAX_RESULT_WEIGHT:,} values", data)

    def _failed(self, reason: str, data: Variables) -> ExpressionError:
        shown = ", ".join(f"{name} = {_shown(value)}" for name, value in data.items())
        return ExpressionError(
            f"`${{{shorten_text(self.text)}}}`: {reason.strip()}", hint=f"with {shown}" if shown else None
        )


def compile_expression(text: str) -> Expression:
    """Compile the text between `${` and `}`.

    Raises:
        ExpressionError: it is malformed, or exceeds the step limit for any values.
    """
    text = text.strip()
    if len(text) > MAX_LENGTH:
        raise ExpressionError(
            f"`${{{shorten_text(text)}}}`: longer than {MAX_LENGTH} characters", hint="use a state instead"
        )
    if not text:
        raise ExpressionError("`${}`: the expression is empty", hint="write a name or a formula")
    return _COMPILED.get(text, _compile)


def _compile(text: str) -> Expression:
    if _NAME.fullmatch(text) and text not in RESERVED:
        return Expression(text, frozenset((text,)), 1.0, None, None, (), {})
    parsed = _parse(text)
    uses = tuple(use for use in parsed.free_names() if use[0] not in RESERVED)
    names = tuple(dict.fromkeys(name for name, _ in uses))
    _check_names(text, names, uses)
    aliases = {name: alias(number) for number, name in enumerate(names)}
    program = _checked_program(text, aliased(text, uses, aliases))
    made = Expression(text, frozenset(names), 0.0, program, parsed.root, uses, aliases)
    least = made.steps(dict.fromkeys(names, SCALAR))
    if least > MAX_STEPS:
        raise made.too_long(least)
    return Expression(text, made.names, _small_steps(made), program, parsed.root, uses, aliases)


def _small_steps(made: Expression) -> float:
    try:
        return made.steps(dict.fromkeys(made.names, SMALL))
    except ExpressionError:
        return math.inf  # the cost depends on the value, for example a pattern


_COMPILED: TextCache[Expression] = TextCache(max_characters=150_000)
_TYPES: TextCache[ValueType] = TextCache(max_characters=500_000)


def _parse(text: str) -> ParsedExpression:
    try:
        return read_parsed(environment().compile(text, disable_check=True).serialize())
    except RuntimeError as error:
        for _, column, reason in _ERROR_LINE.findall(str(error)):
            raise _malformed(text, _to_plain_words(reason), int(column)) from None
        reason = _ERROR_STATUS.sub("", str(error)).splitlines()[0]
        raise ExpressionError(f"`${{{shorten_text(text)}}}`: {reason}", hint="use a simpler expression") from None


def _check_names(text: str, names: tuple[str, ...], uses: tuple[NameUse, ...]) -> None:
    if len(names) > MAX_NAMES:
        raise _malformed(text, f"it uses more than {MAX_NAMES} names")
    if ALIAS in text:
        raise _malformed(text, f"`{ALIAS}` cannot be part of an expression")
    for name, start in uses:
        if not _NAME.fullmatch(name) or text[start : start + len(name)] != name:
            raise _malformed(text, f"`{name}` is not a valid name")


def _checked_program(text: str, called: str) -> Any:
    """Compile an expression, without type check if its only type errors mix integers and decimals.

    The type check of CEL refuses `1 < 2.5`, its evaluator computes it correctly.
    """
    try:
        return environment().compile(called)
    except RuntimeError as error:
        for _, _, reason in _ERROR_LINE.findall(str(error)):
            if not _MIXED_NUMBERS.match(reason):
                raise _malformed(text, _to_plain_words(reason)) from None
    try:
        return environment().compile(called, disable_check=True)
    except RuntimeError as error:
        reason = _ERROR_STATUS.sub("", str(error)).splitlines()[0]
        raise ExpressionError(f"`${{{shorten_text(text)}}}`: {reason}", hint="use a simpler expression") from None


def _malformed(text: str, reason: str, column: int = 0) -> ExpressionError:
    hint = f"at character {column}" if column > 0 else None
    return ExpressionError(f"`${{{shorten_text(text)}}}`: {reason}", hint=hint)


def _to_plain_words(reason: str) -> str:
    unknown = _UNDECLARED.match(reason)
    if unknown:
        return f"there is no function `{unknown[1]}`"
    # The parser lists every expected token; the author needs only the unexpected one.
    return re.sub(r" expecting \{.*", "", reason).replace("'<EOF>'", "end")


def _result_type(text: str, called: str) -> ValueType:
    def read(called: str) -> ValueType:
        try:
            return word_for(environment().compile(called).return_type().name())
        except RuntimeError as error:
            for _, _, reason in _ERROR_LINE.findall(str(error)):
                if impossible := _impossible(reason):
                    raise ExpressionError(f"`${{{shorten_text(text)}}}`: {impossible}") from None
            return "anything"

    return _TYPES.get(called, read)


def _impossible(reason: str) -> str | None:
    """Return the operation that fails at run time; None for errors of the type check only."""
    selected = _NO_FIELDS.match(reason)
    if selected:
        return f"{_type_name(selected[1])} has no fields"
    refused = _NO_OVERLOAD.match(reason)
    if refused is None or refused[1] not in _STRICT or _MIXED_NUMBERS.match(reason):
        return None
    operands = [_type_name(operand) for operand in re.split(r", (?![^(]*\))", refused[2])]
    return f"`{_SYMBOL.sub('', refused[1])}` cannot be applied to {' and '.join(operands)}"


def _type_name(of_cel: str) -> str:
    known = {
        "string": "text",
        "int": "an integer",
        "double": "a number",
        "bool": "true or false",
        "null_type": "nothing",
        "list": "a list",
        "map": "a mapping",
    }
    return known.get(of_cel.partition("(")[0], of_cel)


def too_much_text(length: int) -> str:
    """Return the message for a text that is too long."""
    return f"the text has {length:,} characters; the maximum is {MAX_TEXT:,}"


def _shown(value: object) -> str:
    """Return the beginning of a value for a message, without formatting all of a large value."""
    if isinstance(value, str):
        return shorten_text(repr(value[:100]))
    if isinstance(value, list | tuple | dict):
        items = cast("Sized", value)
        return shorten_text(repr(items)) if len(items) <= 20 else f"a {type(items).__name__} of {len(items)}"
    return shorten_text(repr(value))


def _plain(value: object) -> object:
    """Return a value in the types that CEL knows.

    Raises:
        ValueError: a text contains a NUL character, at which cel-expr-python 0.1 would cut it.
    """
    if isinstance(value, str):
        if "\0" in value:
            raise ValueError(f"the text {shorten_text(repr(value))} contains a NUL character")
        return value
    if value is None or isinstance(value, bool | int | float):
        return value
    if isinstance(value, Mapping):
        return {_plain(key): _plain(item) for key, item in cast("Mapping[str, object]", value).items()}
    if isinstance(value, list | tuple):
        return [_plain(item) for item in cast("list[object]", value)]
    return _plain(msgspec.to_builtins(value)) if isinstance(value, msgspec.Struct) else value


def shorten_text(text: str) -> str:
    """Return the beginning of a text on one line."""
    text = " ".join(text[:200].split())
    return text if len(text) <= 80 else f"{text[:77]}…"
