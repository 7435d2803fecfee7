"""Reads behavior documents together with the behaviors they refer to, each file once."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from types import MappingProxyType

import msgspec

from engine.document.behavior import Behavior, BehaviorDocument
from engine.document.document_kind import require_kind
from engine.document.partial_behavior import read_partial_behavior
from engine.document.structural_rules import require_structural_rules
from engine.document.text.decoding import decode_document
from engine.document.text.mistakes import MAX_MISTAKES
from engine.document.text.text_recovery import RecoveredText, load_recovering, recover_text
from engine.document.text.yaml_source import DocumentSource, load_source, parse_source
from engine.errors import DocumentError, Position

MAX_CHAIN = 64
MAX_EXPANDED_NODES = 50_000
"""Maximum number of nodes; each takes about 2 kB in a plan."""


@dataclass(frozen=True, kw_only=True)
class CircularReference:
    """A chain of files in which the last one refers to the first, at `position`."""

    chain: tuple[Path, ...]
    position: Position

    def __str__(self) -> str:
        return " → ".join(file.name for file in (*self.chain, self.chain[0]))


@dataclass(frozen=True, kw_only=True)
class BehaviorSurvey:
    """The result of reading a document before the check.

    `behavior` is None if nothing is readable. With mistakes it has gaps and can only be checked, not run.
    """

    behavior: Behavior | None
    mistakes: tuple[DocumentError, ...] = ()
    circles: tuple[CircularReference, ...] = ()


def load_behavior(path: Path | str) -> Behavior:
    """Read a behavior document and everything it refers to.

    Raises:
        DocumentError: a file cannot be read or is not a valid behavior, or the references are
            circular; `where` is the position.
    """
    behavior, circles = read_behavior(path)
    if circles:
        hint = "a behavior cannot contain itself"
        raise DocumentError(f"circular behavior reference: {circles[0]}", where=circles[0].position, hint=hint)
    return behavior


def read_behavior(path: Path | str) -> tuple[Behavior, tuple[CircularReference, ...]]:
    """Read a behavior like `load_behavior`; also return the circular references, which stay unresolved.

    Raises:
        DocumentError: a file cannot be read or is not a valid behavior.
    """
    reading = _Reading()
    behavior = reading.read(Path(path), ())
    return behavior, tuple(reading.circles)


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


def survey_behavior(
    path: Path | str,
    text: bytes | str | None = None,
    *,
    source: DocumentSource | None = None,
    within: Path | None = None,
    unwritten: Mapping[Path, str] | None = None,
) -> BehaviorSurvey:
    """Read a behavior with all its mistakes and those of the behaviors it refers to.

    Args:
        path: Its file.
        text: Edited text to read instead of the file; references are relative to `path`.
        source: The text as it was read already; the text is read again only if it has mistakes.
        within: A folder; references to files outside of it are not read and are mistakes.
        unwritten: Texts to read in place of the referred files at these resolved paths, which need not exist.
    """
    file, texts = Path(path), unwritten or {}
    try:
        if source is not None:
            return _survey_strictly(source, file, texts)
    except DocumentError:
        pass  # the text is read again below, for the positions of all mistakes
    try:
        source = parse_source(text, file=str(path)) if text is not None else load_source(file)
        return _survey_strictly(source, file, texts)
    except DocumentError as refusal:
        first = refusal
    around = _Reading(mistakes=[], within=within, unwritten=texts)
    try:
        recovered = recover_text(text, file=str(path)) if text is not None else load_recovering(file)
        behavior = around.build_around(recovered, file, ())
    except DocumentError as refusal:
        known = around.mistakes if refusal in around.mistakes else [*around.mistakes, refusal]
        return BehaviorSurvey(behavior=None, mistakes=tuple(known))
    mistakes = tuple(around.mistakes[:MAX_MISTAKES] or [first])
    return BehaviorSurvey(behavior=behavior, mistakes=mistakes, circles=tuple(around.circles))


def _survey_strictly(source: DocumentSource, file: Path, unwritten: Mapping[Path, str]) -> BehaviorSurvey:
    reading = _Reading(unwritten=unwritten)
    behavior = reading.build(source, file, ())
    return BehaviorSurvey(behavior=behavior, circles=tuple(reading.circles))


class _Reading:
    """One pass over a document and its references; with a list for mistakes it collects them and continues."""

    def __init__(
        self,
        *,
        mistakes: list[DocumentError] | None = None,
        within: Path | None = None,
        unwritten: Mapping[Path, str] = MappingProxyType({}),
    ) -> None:
        self._unwritten = unwritten
        self._within = within.resolve() if within is not None else None
        self.circles: list[CircularReference] = []
        self.mistakes: list[DocumentError] = mistakes if mistakes is not None else []
        self._goes_around = mistakes is not None
        self._done: dict[Path, Behavior] = {}
        self._failed: set[Path] = set()
        self._expanded: dict[int, int] = {}
        """By the id of each behavior that was read: its nodes, with its references expanded."""

    def read(self, file: Path, chain: tuple[Path, ...]) -> Behavior:
        known = self._done.get(_identity(file))
        if known is not None:
            return known
        text = self._unwritten.get(_identity(file))
        if self._goes_around:
            recovered = load_recovering(file) if text is None else recover_text(text, file=str(file))
            behavior = self.build_around(recovered, file, chain)
        else:
            behavior = self.build(
                load_source(file) if text is None else parse_source(text, file=str(file)), file, chain
            )
        self._done[_identity(file)] = behavior
        return behavior

    def build(self, source: DocumentSource, file: Path, chain: tuple[Path, ...]) -> Behavior:
        try:
            document = decode_document(source, BehaviorDocument)
        except DocumentError:
            require_kind(source, "behavior")
            raise
        behavior = Behavior(document=document, file=file, source=source)
        require_structural_rules(behavior)
        return self._complete(behavior, file, chain)

    def build_around(self, recovered: RecoveredText, file: Path, chain: tuple[Path, ...]) -> Behavior:
        self.mistakes += recovered.mistakes
        if recovered.source is None:
            raise recovered.mistakes[0]
        partial = read_partial_behavior(recovered.source, file, recovered.gaps)
        self.mistakes += partial.mistakes
        if partial.behavior is None:
            raise (*recovered.mistakes, *partial.mistakes)[0]
        return self._complete(self._without_outside_cell(partial.behavior), file, chain)

    def _without_outside_cell(self, behavior: Behavior) -> Behavior:
        """Return the behavior without a cell outside of the folder."""
        if behavior.cell_file is None or not self._is_outside(behavior.cell_file):
            return behavior
        self._refuse_outside(str(behavior.document.cell), behavior.source.position(("cell",)))
        return replace(behavior, document=msgspec.structs.replace(behavior.document, cell=None))

    def _is_outside(self, file: Path) -> bool:
        return self._within is not None and not _identity(file).is_relative_to(self._within)

    def _refuse_outside(self, written: str, position: Position) -> None:
        hint = "name a file of this project, relative to this document"
        self._refuse(f"`{written}` leads out of the project", position, hint)

    def _complete(self, behavior: Behavior, file: Path, chain: tuple[Path, ...]) -> Behavior:
        made = replace(behavior, references=self._references(behavior, (*chain, _identity(file))))
        self._expanded[id(made)] = self._count_expanded(made)
        return made

    def _count_expanded(self, behavior: Behavior) -> int:
        """Count the nodes of a behavior with all references expanded."""
        count = 0
        for path, node in behavior.nodes():
            referred = behavior.references.get(node.behavior) if node.behavior is not None else None
            count += 1 + (self._expanded[id(referred)] if referred is not None else 0)
            if count > MAX_EXPANDED_NODES:
                message = f"with its references expanded the behavior has more than {MAX_EXPANDED_NODES} nodes"
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
                raise DocumentError(f"behavior references are nested more than {MAX_CHAIN} deep", where=position)
            if self._is_outside(file):
                self._refuse_outside(written, position)
            elif _identity(file) not in self._unwritten and not file.is_file():
                self._refuse(f"there is no behavior file `{written}`", position, f"looked for {file}")
            elif (referred := self._referred(file, chain)) is not None:
                references[written] = referred
        return references

    def _refuse(self, message: str, position: Position, hint: str) -> None:
        error = DocumentError(message, where=position, hint=hint)
        if not self._goes_around:
            raise error
        self.mistakes.append(error)

    def _referred(self, file: Path, chain: tuple[Path, ...]) -> Behavior | None:
        """Return a referred behavior; None if it is skipped because nothing of it is readable."""
        if _identity(file) in self._failed:
            return None
        try:
            return self.read(file, chain)
        except DocumentError as error:
            if not self._goes_around:
                raise
            self._failed.add(_identity(file))
            self.mistakes += [error] if error not in self.mistakes else []
            return None


def _identity(file: Path) -> Path:
    return file.resolve()
