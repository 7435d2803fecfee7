"""What coverage files hold: for each behavior its documents and how often each item was seen."""

from __future__ import annotations

from hashlib import sha256
from pathlib import Path
from typing import Literal

import msgspec

from engine.coverage.coverage_item import CoverageItem
from engine.errors import FlexcellError


class CoveredDocument(msgspec.Struct, frozen=True, kw_only=True):
    """One file of a behavior: the hash of what it means, and of its text, empty where it has none."""

    file: str
    meaning: str
    text: str


class BehaviorCoverage(msgspec.Struct, frozen=True, kw_only=True):
    """How often the items of one behavior were seen in `runs` runs; `document` is the hash of its meaning."""

    behavior: str
    document: str
    runs: int
    documents: tuple[CoveredDocument, ...]
    items: tuple[CoverageItem, ...]

    @property
    def file(self) -> str:
        """The file of the behavior itself."""
        return self.documents[0].file

    @property
    def covered(self) -> int:
        """How many items were seen."""
        return sum(item.count > 0 for item in self.items)

    @property
    def percent(self) -> float:
        """The share of items that were seen."""
        return percent(self.covered, len(self.items))

    def merged(self, newer: BehaviorCoverage) -> BehaviorCoverage:
        """Return the sum of two coverages of the same document, with the places of the newer one."""
        counts = {item.key: item.count for item in self.items}
        items = tuple(msgspec.structs.replace(item, count=item.count + counts.get(item.key, 0)) for item in newer.items)
        return msgspec.structs.replace(newer, runs=self.runs + newer.runs, items=items)


class CoverageFile(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """A coverage file as written."""

    flexcell_coverage: Literal[1] = 1
    behaviors: tuple[BehaviorCoverage, ...] = ()


def percent(covered: int, total: int) -> float:
    """Return a share in percent; of nothing all is covered."""
    return 100.0 * covered / total if total else 100.0


def merge(coverages: tuple[BehaviorCoverage, ...]) -> tuple[BehaviorCoverage, ...]:
    """Return one coverage for each behavior, in the order in which they first appear.

    Raises:
        FlexcellError: two of them are of different versions of one file.
    """
    merged: dict[str, BehaviorCoverage] = {}
    versions: dict[str, str] = {}
    for coverage in coverages:
        for document in coverage.documents:
            if versions.setdefault(document.file, document.meaning) != document.meaning:
                raise FlexcellError(
                    "the coverage is of two different versions of this document",
                    where=document.file,
                    hint="remove the old coverage file and run the behaviors again",
                )
        key = f"{coverage.document} {coverage.file}"
        merged[key] = merged[key].merged(coverage) if key in merged else coverage
    return tuple(merged.values())


def read_coverage(file: Path) -> tuple[BehaviorCoverage, ...]:
    """Return what a coverage file holds.

    Raises:
        FlexcellError: it cannot be read or is no coverage file.
    """
    try:
        return msgspec.json.decode(file.read_bytes(), type=CoverageFile).behaviors
    except OSError as error:
        raise FlexcellError(f"cannot read this file: {error.strerror}", where=file, hint="check its path") from error
    except msgspec.MsgspecError as error:
        hint = "give a file that `flexcell run --coverage` wrote"
        raise FlexcellError(f"this is no coverage file: {error}", where=file, hint=hint) from error


def write_coverage(file: Path, coverages: tuple[BehaviorCoverage, ...]) -> None:
    """Write a coverage file, in one step, so that a reader never finds half of it.

    Raises:
        FlexcellError: it cannot be written.
    """
    text = msgspec.json.format(msgspec.json.encode(CoverageFile(behaviors=coverages)), indent=1)
    part = file.with_name(f"{file.name}.part")
    try:
        part.write_bytes(text + b"\n")
        part.replace(file)
    except OSError as error:
        raise FlexcellError(f"cannot write this file: {error.strerror}", where=file, hint="check its folder") from error


def text_hash(file: Path) -> str:
    """Return the hash of a file's text, empty where it cannot be read."""
    try:
        return sha256(file.read_bytes()).hexdigest()
    except OSError:
        return ""
