"""`${…}` in the text of a document: CEL expressions over parameters and userdata, never Python.

A text that is one expression gives the expression's typed value; expressions inside a longer text
give text. `$${` is a literal `${`. Integers and decimals mix freely in arithmetic: both integers
give an integer (`7 / 2` is 3), else the result is a decimal.
"""

from __future__ import annotations

import math
import operator
import re
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import lru_cache
from typing import Any, Literal, cast

import msgspec
from cel_expr_python import cel

from engine.errors import ExpressionError

MAX_LENGTH = 2_000
RESERVED = frozenset(
    {
        *("as", "break", "const", "continue", "else", "for", "function", "if", "import", "in", "let", "loop"),
        *("namespace", "package", "return", "var", "void", "while", "true", "false", "null"),
        *("bool", "bytes", "double", "dyn", "int", "list", "map", "null_type", "string", "type", "uint"),
    }
)
"""Words of the expression language, which cannot name a parameter or a userdata key."""

ValueType = Literal["boolean", "integer", "number", "text", "list", "mapping", "nothing", "anything"]
"""What is known of a value before a run."""

Variables = Mapping[str, object]
_Evaluation = Callable[[Variables], object]

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
"""What fails when run with the wrong types; comparing unlike values, for one, is only refused by the type check."""
_MIXED_NUMBERS = re.compile(r"found no matching overload for .* applied to '\(.*\b(?:int.*double|double.*int)\b.*\)'")


@dataclass(frozen=True)
class Template:
    """A value in which expressions are replaced on `evaluate`."""

    value: object
    """The value as written."""
    names: frozenset[str]
    """The variables that the expressions use."""
    _evaluate: _Evaluation | None

    @property
    def constant(self) -> bool:
        """True when there is no expression in it."""
        return self._evaluate is None

    def evaluate(self, variables: Variables) -> object:
        """Return the value with its expressions replaced; without expressions, the value itself.

        Raises:
            ExpressionError: a variable is missing or an expression fails; names both.
        """
        return self.value if self._evaluate is None else self._evaluate(variables)


def compile_template(value: object) -> Template:
    """Prepare a value of a document: text, or lists and mappings with text in them.

    Raises:
        ExpressionError: an expression is not well formed.
    """
    names: set[str] = set()
    evaluation = _prepare(value, names)
    return Template(value, frozenset(names), evaluation)


def _prepare(value: object, names: set[str]) -> _Evaluation | None:
    if isinstance(value, str):
        return _prepare_text(value, names) if "${" in value else None
    if isinstance(value, dict):
        return _prepare_mapping(cast("dict[str, object]", value), names)
    if isinstance(value, list | tuple):
        return _prepare_list(cast("list[object]", value), names)
    return None


def _prepare_mapping(mapping: dict[str, object], names: set[str]) -> _Evaluation | None:
    live = {key: found for key, item in mapping.items() if (found := _prepare(item, names)) is not None}
    if not live:
        return None
    return lambda variables: {k: live[k](variables) if k in live else item for k, item in mapping.items()}


def _prepare_list(items: list[object], names: set[str]) -> _Evaluation | None:
    live = {index: found for index, item in enumerate(items) if (found := _prepare(item, names)) is not None}
    if not live:
        return None
    return lambda variables: [live[i](variables) if i in live else item for i, item in enumerate(items)]


def _prepare_text(text: str, names: set[str]) -> _Evaluation:
    pieces = split_text(text)
    for piece in pieces:
        if isinstance(piece, Expression):
            names |= piece.names
    if len(pieces) == 1:
        only = pieces[0]
        return only.evaluate if isinstance(only, Expression) else lambda variables: only
    return lambda variables: "".join(p if isinstance(p, str) else as_text(p.evaluate(variables)) for p in pieces)


def split_text(text: str) -> list[str | Expression]:
    """Return the literal pieces and the expressions of a text in order.

    Raises:
        ExpressionError: an expression is not well formed.
    """
    pieces: list[str | Expression] = []
    literal = ""
    index = 0
    while index < len(text):
        if text.startswith("$${", index):
            literal += "${"
            index += 3
        elif text.startswith("${", index):
            end = _closing_brace(text, index + 2)
            pieces += [literal] if literal else []
            pieces.append(compile_expression(text[index + 2 : end]))
            literal = ""
            index = end + 1
        else:
            literal += text[index]
            index += 1
    return [*pieces, literal] if literal or not pieces else pieces


def _closing_brace(text: str, start: int) -> int:
    """Return the index of the brace that closes an expression, passing over its own braces and quotes."""
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
    raise ExpressionError(f"`{_short(text)}`: `${{` is not closed", hint="add `}`, or write `$${` for the characters")


def as_text(value: object) -> str:
    """Return a value as it appears inside text: text as it is, everything else as JSON."""
    return value if isinstance(value, str) else msgspec.json.encode(value).decode()


@dataclass(frozen=True)
class Expression:
    """One compiled expression and the variables it uses."""

    text: str
    names: frozenset[str]
    _program: Any  # cel.Expression; None where the expression is just the name of a variable

    @property
    def bare(self) -> bool:
        """True when it is just the name of a variable."""
        return self._program is None

    def result_type(self, variables: Mapping[str, ValueType]) -> ValueType:
        """Return the type of its value, as far as the types of the variables tell.

        Raises:
            ExpressionError: it fails whenever the variables have these types; says at which operation.
        """
        if self.bare:
            return variables.get(self.text, "anything")
        return _result_type(self.text, tuple((name, variables.get(name, "anything")) for name in sorted(self.names)))

    def evaluate(self, variables: Variables) -> object:
        """Return the value of the expression.

        Raises:
            ExpressionError: a variable is missing, or the evaluation fails.
        """
        if self._program is None:
            return self._variable(variables, self.text)
        data = {name: _plain(self._variable(variables, name)) for name in self.names}
        try:
            result = self._program.eval(data=data)
        except (RuntimeError, ValueError, TypeError, OverflowError) as error:
            raise self._failed(_ERROR_STATUS.sub("", str(error)), data) from error
        if result.type() == cel.Type.ERROR:
            raise self._failed(_ERROR_STATUS.sub("", str(result.value())), data)
        return self._checked(result.plain_value(), data)

    def _variable(self, variables: Variables, name: str) -> object:
        if name not in variables:
            raise ExpressionError(
                f"`${{{self.text}}}`: `{name}` is not defined", hint="it is no parameter or userdata key"
            )
        return variables[name]

    def _checked(self, value: object, data: Variables) -> object:
        if isinstance(value, float) and not math.isfinite(value):
            raise self._failed(f"the result is {value}", data)
        if value is not None and not isinstance(value, bool | int | float | str | list | dict):
            raise self._failed(f"the result is a {type(value).__name__}, which no document value can be", data)
        return cast("object", value)

    def _failed(self, reason: str, data: Variables) -> ExpressionError:
        shown = ", ".join(f"{name} = {_short(repr(value))}" for name, value in data.items())
        return ExpressionError(f"`${{{_short(self.text)}}}`: {reason.strip()}", hint=f"with {shown}" if shown else None)


@lru_cache(maxsize=4096)
def compile_expression(text: str) -> Expression:
    """Compile the text between `${` and `}`.

    Raises:
        ExpressionError: it is not well formed; names the place and the reason.
    """
    text = text.strip()
    if len(text) > MAX_LENGTH:
        raise ExpressionError(f"`${{{_short(text)}}}`: longer than {MAX_LENGTH} characters", hint="use a state instead")
    if not text:
        raise ExpressionError("`${}`: the expression is empty", hint="write a name or a formula")
    if _NAME.fullmatch(text) and text not in RESERVED:
        return Expression(text, frozenset((text,)), None)
    names: frozenset[str] = frozenset()
    while True:
        try:
            return Expression(text, names, _environment(names).compile(text))
        except RuntimeError as error:
            complaint = str(error)
        found = frozenset(reference.split(".")[0] for reference in _UNDECLARED.findall(complaint))
        if found <= names or found & RESERVED:
            return Expression(text, names, _without_types(text, names, complaint))
        names |= found


def _without_types(text: str, names: frozenset[str], complaint: str) -> Any:
    """Compile an expression whose only fault is that it compares integers with decimals.

    CEL refuses `1 < 2.5` before running it and computes it well when run.
    """
    for _, column, reason in _ERROR_LINE.findall(complaint):
        if not _MIXED_NUMBERS.match(reason):
            place = f"at character {column}" if int(column) > 0 else None
            raise ExpressionError(f"`${{{_short(text)}}}`: {_in_words(reason)}", hint=place)
    try:
        return _environment(names).compile(text, disable_check=True)
    except RuntimeError as error:
        reason = _ERROR_STATUS.sub("", str(error)).splitlines()[0]
        raise ExpressionError(f"`${{{_short(text)}}}`: {reason}", hint="use a simpler expression") from None


def _in_words(reason: str) -> str:
    unknown = _UNDECLARED.match(reason)
    if unknown:
        return f"there is no function `{unknown[1]}`"
    # The parser lists every token it would have accepted; the reader only needs what it met.
    return re.sub(r" expecting \{.*", "", reason).replace("'<EOF>'", "end")


@lru_cache(maxsize=4096)
def _result_type(text: str, variables: tuple[tuple[str, ValueType], ...]) -> ValueType:
    try:
        program = _typed_environment(variables).compile(text)
    except RuntimeError as error:
        for _, _, reason in _ERROR_LINE.findall(str(error)):
            if impossible := _impossible(reason):
                raise ExpressionError(f"`${{{_short(text)}}}`: {impossible}") from None
        return "anything"
    return _words_for(program.return_type().name())


def _impossible(reason: str) -> str | None:
    """Say what fails when run; None for what only the type check refuses."""
    selected = _NO_FIELDS.match(reason)
    if selected:
        return f"{_type_in_words(selected[1])} has no fields"
    refused = _NO_OVERLOAD.match(reason)
    if refused is None or refused[1] not in _STRICT or _MIXED_NUMBERS.match(reason):
        return None
    operands = [_type_in_words(operand) for operand in re.split(r", (?![^(]*\))", refused[2])]
    return f"`{_SYMBOL.sub('', refused[1])}` cannot be applied to {' and '.join(operands)}"


def _type_in_words(of_cel: str) -> str:
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


@lru_cache(maxsize=1)
def _cel_types() -> Mapping[ValueType, Any]:
    kinds = cel.Type
    return {
        "boolean": kinds.BOOL,
        "integer": kinds.INT,
        "number": kinds.DOUBLE,
        "text": kinds.STRING,
        "list": kinds.LIST,
        "mapping": kinds.MAP,
        "nothing": kinds.NULL,
        "anything": kinds.DYN,
    }


def _words_for(of_cel: str) -> ValueType:
    outer = of_cel.partition("<")[0]
    for word, known in _cel_types().items():
        if known.name().partition("<")[0] == outer:
            return word
    return "anything"


@lru_cache(maxsize=1024)
def _typed_environment(variables: tuple[tuple[str, ValueType], ...]) -> Any:
    known = {name: _cel_types()[kind] for name, kind in variables}
    return cel.NewEnv(variables=known, extensions=[_mixed_arithmetic()])


def _environment(names: frozenset[str]) -> Any:
    return _typed_environment(tuple((name, "anything") for name in sorted(names)))


@lru_cache(maxsize=1)
def _mixed_arithmetic() -> Any:
    """Let an integer meet a decimal in `+ - * /`, which CEL alone refuses."""
    integer, decimal = cel.Type.INT, cel.Type.DOUBLE
    functions: list[Any] = []
    for symbol, compute in (("+", operator.add), ("-", operator.sub), ("*", operator.mul), ("/", _divide)):
        overloads = [
            cel.Overload(f"mixed_{compute.__name__}_{order}", decimal, list(pair), False, compute)
            for order, pair in (("left", (integer, decimal)), ("right", (decimal, integer)))
        ]
        functions.append(cel.FunctionDecl(f"_{symbol}_", overloads))
    return cel.CelExtension("mixed_arithmetic", functions)


def _divide(dividend: float, divisor: float) -> float:
    # A raised error would leave the evaluator in the middle; infinity is refused as a result.
    return dividend / divisor if divisor else math.inf


def _plain(value: object) -> object:
    """Return a value in the types that CEL knows."""
    if value is None or isinstance(value, bool | int | float | str):
        return value
    if isinstance(value, Mapping):
        return {key: _plain(item) for key, item in cast("Mapping[str, object]", value).items()}
    if isinstance(value, list | tuple):
        return [_plain(item) for item in cast("list[object]", value)]
    return _plain(msgspec.to_builtins(value)) if isinstance(value, msgspec.Struct) else value


def _short(text: str) -> str:
    return text if len(text) <= 80 else f"{text[:77]}…"
