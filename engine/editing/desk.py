"""The texts that are being edited, kept as they were read: what comes next to one need not read it again."""

from __future__ import annotations

import threading
from collections import OrderedDict
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from engine.document.collection_pause import collection_paused
from engine.editing.apply import Edited, apply_edits, apply_to
from engine.editing.draft import Draft
from engine.editing.edit import AnyEdit
from engine.editing.examination import Examination, checked, draw, unread
from engine.editing.knowledge import Knowledge
from engine.errors import DocumentError
from engine.library import FindingView

KEPT = 6
"""So many texts are kept: the last steps of a few pages; one of 1,000 states takes some 10 MB."""
KEPT_ENTRIES = 60_000
"""Entries in the kept texts together, each of some 500 bytes; the newest text is kept whatever it has."""


@dataclass
class _Sheet:
    """What is known of one text; its draft goes with the edit that uses it."""

    drawn: Examination
    draft: Draft | None


class Desk:
    """Draws, edits and checks texts, and keeps the last ones; may be used from any thread."""

    def __init__(self, *, kept: int = KEPT) -> None:
        self._kept = kept
        self._sheets: OrderedDict[tuple[Path, str], _Sheet] = OrderedDict()
        self._lock = threading.Lock()

    @property
    def kept_entries(self) -> int:
        """Entries in the texts that are kept, counted by their separators."""
        return sum(text.count("\n") + text.count(",") for _, text in self._sheets)

    def draw(self, text: str, *, file: Path, knowledge: Knowledge) -> Examination:
        """Read and draw a text; what is wrong with it is looked for only where it cannot be read."""
        with collection_paused():
            draft = self._taken(file, text)
            try:
                draft = draft or Draft(text, file=str(file))
            except DocumentError as error:
                return unread(text, error, file=file, knowledge=knowledge)
            return self._put(draft, file, knowledge)

    def edit(
        self, text: str, edits: Sequence[AnyEdit], *, file: Path, knowledge: Knowledge
    ) -> tuple[Edited, Examination]:
        """Make edits in a text, all or none, and draw what comes of it."""
        with collection_paused():
            done = self._edited(text, edits, file, knowledge)
            if done.draft is not None:
                return done, self._put(done.draft, file, knowledge)
        return done, self.draw(text, file=file, knowledge=knowledge)

    def examine(self, text: str, *, file: Path, knowledge: Knowledge) -> Examination:
        """Draw a text and look for what is wrong with it."""
        drawn = self.draw(text, file=file, knowledge=knowledge)
        with collection_paused():
            return checked(drawn, text, file=file, knowledge=knowledge)

    def findings(self, text: str, *, file: Path, knowledge: Knowledge) -> tuple[FindingView, ...]:
        """Look for what is wrong with a text; one that was drawn just now is not drawn again."""
        with self._lock:
            sheet = self._sheets.get((file, text))
        drawn = sheet.drawn if sheet is not None else self.draw(text, file=file, knowledge=knowledge)
        with collection_paused():
            return checked(drawn, text, file=file, knowledge=knowledge).findings

    def _edited(self, text: str, edits: Sequence[AnyEdit], file: Path, knowledge: Knowledge) -> Edited:
        draft = self._taken(file, text)
        if draft is not None:
            return apply_to(draft, edits, knowledge=knowledge)
        return apply_edits(text, edits, file=str(file), knowledge=knowledge)

    def _taken(self, file: Path, text: str) -> Draft | None:
        """Return the draft of a text, once: who takes it may change it."""
        with self._lock:
            sheet = self._sheets.get((file, text))
            if sheet is None:
                return None
            draft, sheet.draft = sheet.draft, None
            return draft

    def _put(self, draft: Draft, file: Path, knowledge: Knowledge) -> Examination:
        drawn = draw(draft, file=file, knowledge=knowledge)
        with self._lock:
            self._sheets[file, draft.given] = _Sheet(drawn, draft)
            self._sheets.move_to_end((file, draft.given))
            while len(self._sheets) > 1 and self._too_much():
                self._sheets.popitem(last=False)
        return drawn

    def _too_much(self) -> bool:
        return len(self._sheets) > self._kept or self.kept_entries > KEPT_ENTRIES
