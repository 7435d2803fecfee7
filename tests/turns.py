"""Which tests take turns: each change runs a share of those that cost most, see docs/decisions/0079."""

from __future__ import annotations

import re
from dataclasses import dataclass
from pathlib import Path
from typing import Self
from zlib import crc32

from tests.tiers import ROOT, kinds_of

ALWAYS = re.compile(r"tests/(house|replay)/|(^|[/_])stops?([/_.]|$)")
"""Tests that are in every turn: of the architecture, of recordings, and of what stops robots."""
_DEFINED = re.compile(r"^( *)(?:class (Test\w*)|(?:async )?def (test\w*))\b", re.MULTILINE)


@dataclass(frozen=True)
class Turn:
    """The `number`th of `count` turns, from 1; together they have every test."""

    number: int
    count: int

    @classmethod
    def parse(cls, text: str) -> Self:
        """Read `2/3`; raises ValueError for what is none."""
        match = re.fullmatch(r"(\d+)/(\d+)", text)
        if match is None or not 1 <= int(match[1]) <= int(match[2]):
            raise ValueError(f"`{text}` is no turn: write 2/3 for the second of three")
        return cls(int(match[1]), int(match[2]))

    def has(self, node_id: str, file: Path) -> bool:
        """Return whether it has a test; all values of a test are in the same turn, in any order, on any machine."""
        return not takes_turns(file) or self._has_name(node_id.partition("[")[0])

    def has_any_of(self, file: Path) -> bool:
        """Return whether it has a test of a file; the others need not even be read."""
        return not takes_turns(file) or any(map(self._has_name, defined_tests(file)))

    def _has_name(self, name: str) -> bool:
        return crc32(name.encode()) % self.count == self.number - 1


def takes_turns(file: Path) -> bool:
    """Return whether the tests of a file are costly, and may be left to another change."""
    name = file.relative_to(ROOT).as_posix() if file.is_relative_to(ROOT) else ""
    return bool(kinds_of(file)) and not ALWAYS.search(name)


def defined_tests(file: Path) -> frozenset[str]:
    """Return the node ids of the tests that a file defines, without values, as its text has them."""
    names: set[str] = set()
    around = file.relative_to(ROOT).as_posix()
    for indent, class_name, function in _DEFINED.findall(file.read_text(encoding="utf-8")):
        if class_name:
            around = f"{file.relative_to(ROOT).as_posix()}::{class_name}"
        else:
            names.add(f"{around if indent else file.relative_to(ROOT).as_posix()}::{function}")
    return frozenset(names)
