"""Random ways to write plain data as YAML by hand: comments, blank lines, quotes, braces, all kinds of indentation."""

from __future__ import annotations

import json
import random
from typing import Any, TypeGuard

from hypothesis import strategies as st

Plain = dict[str, Any]
WORDS = (
    "left",
    "right",
    "grasp",
    "speed",
    "hold on",
    "a: b",
    "x # y",
    "${speed}",
    "yes",
    "1.5",
    "",
    "two\nlines\n",
    "é 𝄞",
)
KEYS = ("alpha", "beta", "gamma", "delta", "with", "true", "a b", "x.y", "10", "left/right")

scalars = st.one_of(
    st.none(),
    st.booleans(),
    st.integers(-99, 10**12),
    st.sampled_from((0.5, 1.0, -2.25, 1e-7, 3e20)),
    st.sampled_from(WORDS),
)
trees = st.recursive(
    scalars,
    lambda inside: st.lists(inside, max_size=4) | st.dictionaries(st.sampled_from(KEYS), inside, max_size=4),
    max_leaves=24,
)
documents = st.dictionaries(st.sampled_from(KEYS), trees, min_size=1, max_size=6)
chances = st.builds(random.Random, st.integers(0, 10**6))
"""What decides a layout: one number, for drawing each decision would take most of the time of a test."""


def is_list(value: Any) -> TypeGuard[list[Any]]:
    """Tell whether it is a list."""
    return isinstance(value, list)


def is_mapping(value: Any) -> TypeGuard[dict[str, Any]]:
    """Tell whether it is a mapping."""
    return isinstance(value, dict)


class Layout:
    """Writes data as a person might, decided by `chance`; every comment is another one."""

    def __init__(self, chance: random.Random, *, comments: bool = True) -> None:
        self._chance = chance
        self._comments = comments
        self._count = 0

    def document(self, data: Plain) -> str:
        head = self._lines_above("") if self._odds(3) else []
        start = ["---"] if self._odds(6) else []
        body = self._mapping(data, "") if data else ["{}"]
        tail = self._lines_above("") if self._odds(3) else []
        text = "\n".join([*head, *start, *body, *tail])
        return text if self._odds(6) and " |" not in text else text + "\n"

    def _odds(self, one_in: int) -> bool:
        return self._chance.randrange(one_in) == 0

    def _comment(self) -> str:
        self._count += 1
        return f"# note {self._count}."

    def _behind(self) -> str:
        return f"{' ' * self._chance.randint(1, 3)}{self._comment()}" if self._comments and self._odds(4) else ""

    def _lines_above(self, indent: str) -> list[str]:
        found = [""] * (self._chance.randint(1, 2) if self._odds(6) else 0)
        if self._comments and self._odds(5):
            found += [f"{indent}{self._comment()}" for _ in range(self._chance.randint(1, 2))]
        return found

    def _mapping(self, data: Plain, indent: str) -> list[str]:
        lines: list[str] = []
        for key, value in data.items():
            lines += self._lines_above(indent)
            lines += self._entry(f"{indent}{self._key(key)}:", value, indent)
        return lines

    def _entry(self, head: str, value: Any, indent: str, *, item: bool = False) -> list[str]:
        if (is_mapping(value) or is_list(value)) and value and not self._odds(3):
            return self._nested(head, value, indent, item=item)
        if isinstance(value, str) and "\n" in value and not self._odds(3):
            inner = indent + " " * self._chance.randint(1, 3)
            return [f"{head} |", *(f"{inner}{line}" for line in value.rstrip("\n").split("\n"))]
        if value is None and self._odds(3):
            return [head + self._behind()]
        if self._odds(8) and not item:
            return [f"{head}{self._behind()}", f"{indent}   {self._flow(value, indent)}{self._behind()}"]
        return [f"{head} {self._flow(value, indent + '  ')}{self._behind()}"]

    def _nested(self, head: str, value: Plain | list[Any], indent: str, *, item: bool) -> list[str]:
        if is_mapping(value):
            if item and self._odds(2):
                lines = self._mapping(value, f"{indent}  ")
                first = next(i for i, line in enumerate(lines) if line.strip() and not line.lstrip().startswith("#"))
                return [f"{head} {lines[first].lstrip()}", *lines[first + 1 :]]
            inner = indent + " " * self._chance.randint(2 if item else 1, 4)
            return [head + self._behind(), *self._mapping(value, inner)]
        inner = indent + " " * self._chance.choice((2, 4) if item else (0, 2, 4))
        lines = [head + self._behind()]
        for each in value:
            lines += self._lines_above(inner)
            lines += self._entry(f"{inner}-", each, inner, item=True)
        return lines

    def _key(self, key: str) -> str:
        plain = key not in ("true", "10")
        return key if plain and not self._odds(6) else json.dumps(key)

    def _flow(self, value: Any, indent: str) -> str:
        if is_mapping(value):
            return self._between(
                "{", [f"{self._key(k)}: {self._flow(v, indent + ' ')}" for k, v in value.items()], "}", indent
            )
        if is_list(value):
            return self._between("[", [self._flow(v, indent + " ") for v in value], "]", indent)
        return self._scalar(value)

    def _between(self, start: str, parts: list[str], end: str, indent: str) -> str:
        if not parts:
            return start + end
        if self._odds(5):
            inner = f"{indent}  "
            note = f" {self._comment()}" if self._comments and self._odds(3) else ""
            comma = "," if self._odds(3) else ""
            return f"{start}{note}\n{inner}" + f",\n{inner}".join(parts) + f"{comma}\n{indent}{end}"
        space = " " if self._odds(4) else ""
        return f"{start}{space}{(',' if self._odds(5) else ', ').join(parts)}{space}{end}".replace(",-", ", -")

    def _scalar(self, value: Any) -> str:
        if not isinstance(value, str):
            return json.dumps(value)
        if value in ("left", "right", "grasp", "speed", "hold on") and not self._odds(4):
            return value
        if "\n" not in value and not self._odds(3):
            return "'" + value.replace("'", "''") + "'"
        return json.dumps(value, ensure_ascii="𝄞" not in value and self._odds(2))
