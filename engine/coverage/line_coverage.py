"""Coverage by line of the source documents, for HTML, Cobertura and lcov."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from typing import Literal

import msgspec

from engine.coverage.coverage_file import BehaviorCoverage, percent
from engine.coverage.coverage_item import CoverageItem

LineStatus = Literal["covered", "partial", "missed"]


@dataclass(frozen=True, kw_only=True)
class CoverageBranch:
    """One exit of a node; `reached` if the node was entered."""

    item: CoverageItem
    reached: bool


@dataclass(frozen=True, kw_only=True)
class CoverageLine:
    """A line that contains nodes or exits of nodes."""

    number: int
    nodes: tuple[CoverageItem, ...]
    branches: tuple[CoverageBranch, ...]

    @property
    def hits(self) -> int:
        """How often its nodes were entered or, without nodes, its exits were taken."""
        return sum(node.count for node in self.nodes) if self.nodes else sum(each.item.count for each in self.branches)

    @property
    def taken(self) -> int:
        """Number of its exits that were taken."""
        return sum(each.item.count > 0 for each in self.branches)

    @property
    def missing(self) -> tuple[CoverageItem, ...]:
        """The items of the line that are not covered."""
        return tuple(item for item in (*self.nodes, *(each.item for each in self.branches)) if not item.count)

    @property
    def status(self) -> LineStatus:
        """Whether the line is covered, partly covered or missed."""
        if not self.missing:
            return "covered"
        return "partial" if len(self.missing) < len(self.nodes) + len(self.branches) else "missed"


@dataclass(frozen=True, kw_only=True)
class FileCoverage:
    """The lines of one document on which something can be covered, in order."""

    file: str
    text: str
    """The hash of the text to which the line numbers refer."""
    lines: tuple[CoverageLine, ...]

    @property
    def lines_covered(self) -> int:
        """Number of lines reached."""
        return sum(line.hits > 0 for line in self.lines)

    @property
    def branches(self) -> int:
        """Number of exits of nodes."""
        return sum(len(line.branches) for line in self.lines)

    @property
    def branches_taken(self) -> int:
        """Number of exits taken."""
        return sum(line.taken for line in self.lines)

    @property
    def percent(self) -> float:
        """Share of nodes and exits that are covered."""
        total = sum(len(line.nodes) + len(line.branches) for line in self.lines)
        return percent(total - sum(len(line.missing) for line in self.lines), total)


def by_file(coverages: Iterable[BehaviorCoverage]) -> tuple[FileCoverage, ...]:
    """Return the coverage of each file, sorted by name; several uses of a document are summed."""
    texts: dict[str, str] = {}
    merged: dict[tuple[str, int, int, str, str, str], CoverageItem] = {}
    entered: set[tuple[str, int, int, str, str, str]] = set()
    for coverage in coverages:
        texts.update({document.file: document.text for document in coverage.documents})
        nodes = {item.path: item.count for item in coverage.items if item.kind == "node"}
        for item in coverage.items:
            place = (item.file, item.line, item.column, item.kind, item.name, item.target)
            before = merged.get(place)
            merged[place] = msgspec.structs.replace(
                item if before is None else before, count=item.count + (before.count if before is not None else 0)
            )
            if nodes.get(item.path):
                entered.add(place)
    lines: dict[tuple[str, int], list[tuple[CoverageItem, bool]]] = {}
    for place, item in merged.items():
        lines.setdefault((item.file, item.line), []).append((item, place in entered or item.count > 0))
    return tuple(
        FileCoverage(
            file=file,
            text=texts.get(file, ""),
            lines=tuple(_line(number, lines[f, number]) for f, number in sorted(lines) if f == file),
        )
        for file in sorted({file for file, _ in lines})
    )


def _line(number: int, found: list[tuple[CoverageItem, bool]]) -> CoverageLine:
    ordered = sorted(found, key=lambda one: one[0].column)
    return CoverageLine(
        number=number,
        nodes=tuple(item for item, _ in ordered if item.kind == "node"),
        branches=tuple(CoverageBranch(item=item, reached=reached) for item, reached in ordered if item.kind != "node"),
    )
