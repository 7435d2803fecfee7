"""Cache of texts under edit, read and drawn: the next edit reads and draws only what it changes."""

from __future__ import annotations

import threading
from collections import OrderedDict
from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path

from engine.editing.analysis.diagnostics import (
    DocumentAnalysis,
    analyze_unreadable_text,
    draw_document,
    text_hash,
    with_findings,
)
from engine.editing.analysis.document_graph import DrawnGraph
from engine.editing.analysis.graph_difference import GraphDifference, graph_difference
from engine.editing.edits.apply import EditedText, apply_edits, apply_edits_to_draft
from engine.editing.edits.edit import AnyEdit
from engine.editing.project_context import ProjectContext
from engine.editing.text.draft import Draft
from engine.editing.text.outline import Outline
from engine.errors import DocumentError

MAX_TEXTS = 6
"""Maximum number of texts kept: the last steps of a few pages; a text of 1,000 states takes about 10 MB."""
MAX_ENTRIES = 60_000
"""Maximum number of entries in all kept texts, each about 500 bytes; the newest text is always kept."""


@dataclass
class _CachedDraft:
    """Cached data of one text; whoever uses its draft takes it out."""

    graph: DrawnGraph
    outline: Outline
    draft: Draft | None
    entries: int
    """Number of entries in the text, counted by their separators."""


@dataclass(frozen=True, kw_only=True)
class EditAnswer(EditedText, DocumentAnalysis):
    """A text after edits with its findings, and its graph, or the difference from the graph that the asker has."""

    difference: GraphDifference | None = None


class DraftCache:
    """Parses, edits and checks texts, and caches the last ones; thread-safe."""

    def __init__(self, *, kept: int = MAX_TEXTS) -> None:
        self._kept = kept
        self._cache: OrderedDict[tuple[Path, str], _CachedDraft] = OrderedDict()
        self._lock = threading.Lock()

    @property
    def kept_entries(self) -> int:
        """Number of entries in the cached texts."""
        return sum(each.entries for each in self._cache.values())

    def clear(self) -> None:
        """Drop all texts: they are drawn again with other states."""
        with self._lock:
            self._cache.clear()

    def draw(self, text: str, *, file: Path, context: ProjectContext, check: bool = False) -> DocumentAnalysis:
        """Parse a text and build its graph; the check runs if asked for, and if the text cannot be read."""
        try:
            draft, outline, before = self._taken(file, text)
        except DocumentError as error:
            return analyze_unreadable_text(text, error, file=file, context=context)
        analysis, now = self._analyzed(draft, outline, file, context, before, check=check)
        return replace(analysis, graph=now.whole())

    def edit(
        self,
        text: str,
        edits: Sequence[AnyEdit],
        *,
        file: Path,
        context: ProjectContext,
        check: bool = False,
        graph: str | None = None,
    ) -> EditAnswer:
        """Apply edits to a text, all or none, and build the graph of the result.

        Args:
            text: The text.
            edits: The edits.
            file: The file of the text.
            context: The states and behaviors around it.
            check: Whether to find the problems of the result.
            graph: The hash of the text of which the asker has the graph, if any.
        """
        before = self._graph_of(file, text)
        near: DrawnGraph | None = None
        try:
            draft, outline, near = self._taken(file, text)
            done = apply_edits_to_draft(draft, edits, context=context, outline=outline)
        except DocumentError:
            done = apply_edits(text, edits, file=str(file), context=context)
        if done.draft is None or done.outline is None:
            return _answer(done, self.draw(text, file=file, context=context, check=check))
        analysis, now = self._analyzed(done.draft, done.outline, file, context, near, check=check)
        if graph is not None and before is not None and before.nodes and now.nodes and graph == text_hash(text):
            return _answer(done, analysis, graph_difference(graph, before.nodes, now.nodes))
        return _answer(done, replace(analysis, graph=now.whole()))

    def examine(self, text: str, *, file: Path, context: ProjectContext) -> DocumentAnalysis:
        """Build the graph and the findings of a text."""
        return self.draw(text, file=file, context=context, check=True)

    def _graph_of(self, file: Path, text: str) -> DrawnGraph | None:
        with self._lock:
            known = self._cache.get((file, text))
            return known.graph if known is not None else None

    def _taken(self, file: Path, text: str) -> tuple[Draft, Outline, DrawnGraph | None]:
        """Return the draft of a text, to be changed, with its nodes and a graph that has most of them.

        It is that of another text of the file, of which the lines that differ are read, if it was used up: after a
        step back, or for text that was typed.

        Raises:
            DocumentError: the text cannot be read.
        """
        with self._lock:
            own = self._cache.get((file, text))
            others = (each for (at, _), each in reversed(self._cache.items()) if at == file and each.draft is not None)
            known = own if own is not None and own.draft is not None else next(others, None)
            draft = known.draft if known is not None else None
            if known is not None:
                known.draft = None
        if known is None or draft is None:
            draft = Draft(text, file=str(file))
            return draft, Outline(draft.data), None
        if own is not None and known is own:
            return draft, own.outline, own.graph
        draft = draft.reread(text)
        return draft, Outline(draft.data), known.graph

    def _analyzed(
        self,
        draft: Draft,
        outline: Outline,
        file: Path,
        context: ProjectContext,
        before: DrawnGraph | None,
        *,
        check: bool,
    ) -> tuple[DocumentAnalysis, DrawnGraph]:
        drawn, graph = draw_document(draft, outline, file=file, context=context, before=before)
        if check:
            drawn = with_findings(drawn, graph, draft.given, file=file, context=context, read=(draft, outline))
        text = draft.given
        made = _CachedDraft(graph, outline, draft, text.count("\n") + text.count(","))
        with self._lock:
            self._cache[file, text] = made
            self._cache.move_to_end((file, text))
            while len(self._cache) > 1 and self._too_much():
                self._cache.popitem(last=False)
        return drawn, graph

    def _too_much(self) -> bool:
        return len(self._cache) > self._kept or self.kept_entries > MAX_ENTRIES


def _answer(done: EditedText, analysis: DocumentAnalysis, difference: GraphDifference | None = None) -> EditAnswer:
    # The fields as they are: a copy of a large graph would take longer than the edit.
    return EditAnswer(
        **vars(analysis), text=done.text, changed=done.changed, refused=done.refused, difference=difference
    )
