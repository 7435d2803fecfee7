"""Reads behavior documents together with the behaviors they refer to, each file once."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from pathlib import Path

from engine.document.behavior import Behavior, BehaviorDocument
from engine.document.collection_pause import without_collection
from engine.document.conversion import convert
from engine.document.meaning import meaning_hash
from engine.document.structure import require_structure
from engine.document.yaml_source import Source, load_source, parse_source
from engine.errors import DocumentError, Position

MAX_CHAIN = 64
MAX_EXPANDED_NODES = 50_000
"""Each takes some 2 kB in a plan."""


@dataclass(frozen=True, kw_only=True)
class CircularReference:
    """A chain of files in which the last one refers to the first again, closed at `position`."""

    chain: tuple[Path, ...]
    position: Position

    def __str__(self) -> str:
        return " → ".join(file.name for file in (*self.chain, self.chain[0]))


def load_behavior(path: Path | str) -> Behavior:
    """Read a behavior document and everything it refers to.

    Raises:
        DocumentError: a file cannot be read or is not a valid behavior, or behaviors refer to
            one another in a circle; `where` is the position.
    """
    behavior, circles = read_behavior(path)
    if circles:
        hint = "a behavior cannot contain itself"
        raise DocumentError(f"circular behavior reference: {circles[0]}", where=circles[0].position, hint=hint)
    return behavior


@without_collection
def read_behavior(path: Path | str) -> tuple[Behavior, tuple[CircularReference, ...]]:
    """Read a behavior like `load_behavior`, returning circular references, left open, beside it.

    Raises:
        DocumentError: a file cannot be read or is not a valid behavior.
    """
    reading = _Reading()
    behavior = reading.read(Path(path), ())
    return behavior, tuple(reading.circles)


@without_collection
def parse_behavior(text: bytes | str, *, file: Path | str) -> Behavior:
    """Return the behavior that `text` describes; references are read relative to `file`, which need not exist.

    Raises:
        DocumentError: as `load_behavior`.
    """
    reading = _Reading()
    behavior = reading.build(parse_source(text, file=str(file)), Path(file), ())
    if reading.circles:
        circle = reading.circles[0]
        raise DocumentError(f"circular behavior reference: {circle}", where=circle.position)
    return behavior


class _Reading:
    """One pass over a document and its references."""

    def __init__(self) -> None:
        self.circles: list[CircularReference] = []
        self._done: dict[Path, Behavior] = {}
        self._expanded: dict[str, int] = {}

    def read(self, file: Path, chain: tuple[Path, ...]) -> Behavior:
        known = self._done.get(_identity(file))
        if known is not None:
            return known
        behavior = self.build(load_source(file), file, chain)
        self._done[_identity(file)] = behavior
        return behavior

    def build(self, source: Source, file: Path, chain: tuple[Path, ...]) -> Behavior:
        document = convert(source, BehaviorDocument)
        behavior = Behavior(document=document, file=file, meaning="", source=source)
        require_structure(behavior)
        references = self._references(behavior, (*chain, _identity(file)))
        meanings = {written: referred.meaning for written, referred in references.items()}
        meaning = meaning_hash(document, meanings)
        self._expanded[meaning] = self._count_expanded(behavior, meanings)
        return replace(behavior, references=references, meaning=meaning)

    def _count_expanded(self, behavior: Behavior, meanings: Mapping[str, str]) -> int:
        """Count the nodes of a behavior with every use of a reference unfolded."""
        count = 0
        for path, node in behavior.nodes():
            meaning = meanings.get(node.behavior) if node.behavior is not None else None
            count += 1 + (self._expanded[meaning] if meaning is not None else 0)
            if count > MAX_EXPANDED_NODES:
                message = f"with its references unfolded the behavior has more than {MAX_EXPANDED_NODES} nodes"
                raise DocumentError(message, where=behavior.position(path), hint="refer to fewer behaviors")
        return count

    def _references(self, behavior: Behavior, chain: tuple[Path, ...]) -> dict[str, Behavior]:
        references: dict[str, Behavior] = {}
        for path, node in behavior.nodes():
            written = node.behavior
            if written is None or written in references:
                continue
            position = behavior.position(path, "behavior")
            file = behavior.file.parent / written
            if _identity(file) in chain:
                start = chain.index(_identity(file))
                self.circles.append(CircularReference(chain=chain[start:], position=position))
                continue
            if len(chain) >= MAX_CHAIN:
                raise DocumentError(f"behaviors refer to one another more than {MAX_CHAIN} deep", where=position)
            if not file.is_file():
                raise DocumentError(f"there is no behavior file `{written}`", where=position, hint=f"looked for {file}")
            references[written] = self.read(file, chain)
        return references


def _identity(file: Path) -> Path:
    return file.resolve()
