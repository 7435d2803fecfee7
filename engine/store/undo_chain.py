"""The target of an undo: each further undo goes one change back."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from engine.errors import StoreError
from engine.store.rows import ChangeStamp, EntryDraft, RevisionRow, deletion_row, next_row


def undo_target(history: Sequence[RevisionRow]) -> tuple[int, RevisionRow | None]:
    """Return the revision that the next undo restores, and its row; 0 and None when there was no entry before.

    An undo after an undo goes further back, not forward: if revision 4 restored the content of
    revision 2, the next undo restores that of revision 1.

    Raises:
        StoreError: there is no change left to undo.
    """
    by_revision = {row.revision: row for row in history}
    present = _origin(history[-1].revision, by_revision) if history else 0
    if present == 0:
        where = f"{history[0].kind} {history[0].name}" if history else "store"
        raise StoreError("there is no change left to undo", where=where, hint="its history shows every change")
    target = _origin(present - 1, by_revision)

    row = by_revision.get(target)
    return target, None if row is None or row.value is None else row


def undo_row(history: Sequence[RevisionRow], stamp: ChangeStamp) -> RevisionRow:
    """Return the revision that undoes the last change of a history."""
    restores, row = undo_target(history)
    if row is None or row.value is None:
        return deletion_row(history[-1], stamp, restores=restores)
    draft = EntryDraft(kind=row.kind, name=row.name, value=row.value, tags=row.tags)
    return next_row(draft, history[-1], stamp, restores=restores)


def _origin(revision: int, rows: Mapping[int, RevisionRow]) -> int:
    """Return the revision that first had the content of `revision`; 0 before the first."""
    while revision in rows and (restored := rows[revision].restores) is not None:
        revision = restored
    return revision if revision in rows else 0
