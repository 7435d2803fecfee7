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
        name = file.relative_to(ROOT).as_posix() if file.is_relative_to(ROOT) else ""
        if not kinds_of(file) or ALWAYS.search(name):
            return True
        return crc32(node_id.partition("[")[0].encode()) % self.count == self.number - 1
