"""The shared CEL environment in which every expression is compiled.

A separate environment for each set of names costs 150 kB with its first program, so the names in a text are
replaced by aliases that the shared environment declares by type and number, for example `__flexcell_text_0`.

CEL is loaded with the first expression that is not only a name: many behaviors have none.
"""

from __future__ import annotations

import math
import operator
from collections.abc import Mapping, Sequence
from functools import lru_cache
from importlib import import_module
from typing import Any, Literal

MAX_NAMES = 64
"""Maximum number of variables in one expression."""
ALIAS = "__flexcell_"
"""Prefix of aliases; expressions must not use such names."""

ValueType = Literal["boolean", "integer", "number", "text", "list", "mapping", "nothing", "anything"]
"""The static type of a value, known before a run."""

NameUse = tuple[str, int]
"""A name and its character index."""


def alias(number: int, kind: ValueType = "anything") -> str:
    """Return the alias of the variable with this number and type."""
    return f"{ALIAS}{kind}_{number}"


def aliased(text: str, uses: Sequence[NameUse], aliases: Mapping[str, str]) -> str:
    """Return an expression with its variables replaced by their aliases."""
    pieces: list[str] = []
    end = 0
    for name, start in sorted(uses, key=lambda use: use[1]):
        pieces += [text[end:start], aliases[name]]
        end = start + len(name)
    return "".join([*pieces, text[end:]])


@lru_cache(maxsize=1)
def environment() -> Any:
    """Return the environment."""
    known = {alias(number, kind): of_cel for kind, of_cel in _cel_types().items() for number in range(MAX_NAMES)}
    return _cel().NewEnv(variables=known, extensions=[_mixed_arithmetic()])


@lru_cache(maxsize=1)
def error_type() -> Any:
    """Return the type of a result that is an error."""
    return _cel().Type.ERROR


def word_for(of_cel: str) -> ValueType:
    """Return the value type for a CEL type name."""
    outer = of_cel.partition("<")[0]
    for word, known in _cel_types().items():
        if known.name().partition("<")[0] == outer:
            return word
    return "anything"


@lru_cache(maxsize=1)
def _cel_types() -> Mapping[ValueType, Any]:
    kinds = _cel().Type
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


def _mixed_arithmetic() -> Any:
    """Return overloads for mixed integers and decimals in `+ - * /`, which CEL itself refuses."""
    cel = _cel()
    integer, decimal = cel.Type.INT, cel.Type.DOUBLE
    functions: list[Any] = []
    for symbol, compute in (("+", operator.add), ("-", operator.sub), ("*", operator.mul), ("/", _divide)):
        overloads = [
            cel.Overload(f"mixed_{compute.__name__}_{order}", decimal, list(pair), False, compute)
            for order, pair in (("left", (integer, decimal)), ("right", (decimal, integer)))
        ]
        functions.append(cel.FunctionDecl(f"_{symbol}_", overloads))
    return cel.CelExtension("mixed_arithmetic", functions)


def _cel() -> Any:
    return import_module("cel_expr_python.cel")


def _divide(dividend: float, divisor: float) -> float:
    # An exception would abort the evaluator; infinity is refused as a result.
    return dividend / divisor if divisor else math.inf
