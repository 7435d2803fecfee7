"""Expressions, templates and values that are made to keep an evaluator busy; seeded."""

from __future__ import annotations

import random
from collections.abc import Callable

from engine.document.expression.cel_expression import MAX_LENGTH

_NAMES = ("a", "s", "m", "n", "rows")
_ATOMS = ("1", "2.5", "'x'", "[1, 2, 3]", "[]", "{'k': 1}", "true", "null", "9223372036854775807")
_OPERATORS = ("-", "*", "/", "%", "<", ">=", "==", "!=", "&&", "||")
_PATTERNS = ("'(x{20}){9}'", "'.*y.*'", "'.{900}'", "'\\\\pL{100}'", "'(a|b|ab)*c'", "s")
_GARBAGE = "${}'\"\\ ab1+*.()[]<?:&|,\n\t\u00e9\U0001f600"
_DEPTH = 5


def hostile_text(chance: random.Random) -> str:
    """Return a text with one or many expressions, some of them no expression at all."""
    kind = chance.random()
    if kind < 0.1:
        return "${" + "".join(chance.choices(_GARBAGE, k=chance.choice((5, 50, 900)))) + "}"
    if kind < 0.15:
        return "".join(f"${{v{number} + 1}}" for number in range(chance.choice((10, 99, 2_000))))
    if kind < 0.2:
        return " ".join(f"${{{_expression(chance, 2, ())}}}" for _ in range(chance.choice((2, 20))))
    if kind < 0.3:
        name, start = chance.choice((("a", "[a]"), ("a", "[s]"), ("a", "[[1, 2]]")))
        step = chance.choice((".map(a, a + a)", ".map(a, [a, a])", ".map(a, a + [a])", ".map(a, a.map(b, a))"))
        return "${" + start + step * chance.randint(1, 30) + f".filter({name}, {name} in {name})" + "}"
    text = _expression(chance, 0, ())
    while len(text) > MAX_LENGTH:
        text = _expression(chance, 0, ())
    return f"${{{text}}}"


def hostile_data(chance: random.Random) -> dict[str, object]:
    """Return values for the names in hostile texts, from nothing to far too much."""
    count = chance.choice((0, 3, 20, 100, 300)) if chance.random() < 0.95 else chance.choice((1_000, 5_000))
    several = (chance.randint(0, 12) for _ in range(chance.choice((0, 0, 4, 4, 20, 50))))
    lists: tuple[object, ...] = (
        list(range(count)),
        [float(number) for number in range(count)],
        [str(number) * chance.randint(1, 20) for number in range(count)],
        5,
    )
    inside: tuple[object, ...] = (7, "t" * 50, [3] * 5, {"k": "v"})
    return {
        "a": chance.choice(lists),
        "s": "x" * (chance.choice((0, 10, 10, 1_000, 90_000)) if chance.random() < 0.97 else 1_000_000),
        "m": {f"k{number}": chance.choice(inside) for number in range(chance.choice((0, 0, 0, 3, 3, 100)))},
        "n": chance.choice((1, 2.5, True, None, 10**30)),
        "rows": [list(range(length)) for length in several],
    }


def _expression(chance: random.Random, depth: int, bound: tuple[str, ...]) -> str:
    names = (*_NAMES, *bound)
    if depth >= _DEPTH or chance.random() < 0.2:
        return chance.choice((*names, chance.choice(_ATOMS), f"'{'y' * chance.randint(0, 60)}'"))
    variable = f"v{depth}"

    def inner(*more: str) -> str:
        return _expression(chance, depth + 1, (*bound, *more))

    name = chance.choice(names)
    makers: tuple[Callable[[], str], ...] = (
        lambda: f"({inner()} + {inner()})",
        lambda: f"({name} + {name})",
        lambda: f"({inner()} {chance.choice(_OPERATORS)} {inner()})",
        lambda: f"({name} in {inner()})",
        lambda: f"{name}.map({variable}, {inner(variable)})",
        lambda: f"{name}.map({variable}, {name}.map(w, {variable}))",
        lambda: f"{name}.filter({variable}, {variable} in {name})",
        lambda: f"{name}.exists({variable}, {inner(variable)} == {name})",
        lambda: f"{name}.all({variable}, {chance.choice(names)} in {chance.choice(names)})",
        lambda: f"{name}.exists_one({variable}, {variable} == {inner(variable)})",
        lambda: f"[{', '.join(inner() for _ in range(chance.randint(0, 4)))}]",
        lambda: f"{{'k': {inner()}, 'l': {inner()}}}",
        lambda: f"size({inner()})",
        lambda: f"string({inner()})",
        lambda: f"s.contains({chance.choice(names)})",
        lambda: f"s.matches({chance.choice(_PATTERNS)})",
        lambda: f"({inner()} == {inner()} ? {inner()} : {inner()})",
        lambda: f"{name}[{inner()}]",
        lambda: f"{name}.k",
        lambda: f"!({inner()} in {name})",
        lambda: f"size(bytes(s + {name}))",
    )
    return chance.choice(makers)()
