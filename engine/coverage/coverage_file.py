"""Content of coverage files: for each behavior its documents and the count of each item."""

from __future__ import annotations

from hashlib import sha256
from pathlib import Path
from typing import Literal

import msgspec

from engine.coverage.coverage_item import CoverageItem
from engine.errors import FlexcellError


class CoveredDocument(msgspec.Struct, frozen=True, kw_only=True):
    """One file of a behavior: its semantic hash, and the hash of its text, empty if there is no text."""

    file: str
    meaning: str
    text: str


class BehaviorCoverage(msgspec.Struct, frozen=True, kw_only=True):
    """Counts of the items of one behavior in `runs` runs; `document` is its semantic hash."""

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
        """Number of covered items."""
        return sum(item.count > 0 for item in self.items)

    @property
    def percent(self) -> float:
        """Share of covered items in percent."""
        return percent(self.covered, len(self.items))

    def merged(self, newer: BehaviorCoverage) -> BehaviorCoverage:
        """Return the sum of two coverages of the same document, with the positions of the newer one."""
        counts = {item.key: item.count for item in self.items}
        items = tuple(msgspec.structs.replace(item, count=item.count + counts.get(item.key, 0)) for item in newer.items)
        return msgspec.structs.replace(newer, runs=self.runs + newer.runs, items=items)


class CoverageFile(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """A coverage file as written."""

    flexcell_coverage: Literal[1] = 1
    behaviors: tuple[BehaviorCoverage, ...] = ()


def percent(covered: int, total: int) -> float:
    """Return a share in percent; 100 for an empty total."""
    return 100.0 * covered / total if total else 100.0


def merge(coverages: tuple[BehaviorCoverage, ...]) -> tuple[BehaviorCoverage, ...]:
    """Return one coverage for each behavior, in the order in which they first appear.

    Raises:
        FlexcellError: two coverages have different versions of one file.
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
    """Read a coverage file.

    Raises:
        FlexcellError: the file cannot be read or is not a coverage file.
    """
    try:
        return msgspec.json.decode(file.read_bytes(), type=CoverageFile).behaviors
    except OSError as error:
        raise FlexcellError(f"cannot read this file: {error.strerror}", where=file, hint="check its path") from error
    except msgspec.MsgspecError as error:
        hint = "give a file that `flexcell run --coverage` wrote"
        raise FlexcellError(f"this is not a coverage file: {error}", where=file, hint=hint) from error


def write_coverage(file: Path, coverages: tuple[BehaviorCoverage, ...]) -> None:
    """Write a coverage file atomically, so that a reader never reads a partial file.

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
    """Return the hash of a file's text; empty if it cannot be read."""
    try:
        return sha256(file.read_bytes()).hexdigest()
    except OSError:
        return ""
