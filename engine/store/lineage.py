"""What undoing a change brings back: each undo goes one step further into the past."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from engine.errors import StoreError
from engine.store.row import Draft, Row, Stamp, deletion_row, next_row


def undone(history: Sequence[Row]) -> tuple[int, Row | None]:
    """Return the revision that the next undo restores, and its row; 0 and None where there was no entry before.

    Undoing an undo goes on backwards instead of forwards again: the content of revision 4 that
    restored revision 2 is followed by that of revision 1.

    Raises:
        StoreError: nothing is left to undo.
    """
    by_revision = {row.revision: row for row in history}
    here = _origin(history[-1].revision, by_revision) if history else 0
    if here == 0:
        place = f"{history[0].kind} {history[0].name}" if history else "store"
        raise StoreError("nothing is left to undo", where=place, hint="its history shows every change")
    target = _origin(here - 1, by_revision)
    row = by_revision.get(target)
    return target, None if row is None or row.value is None else row


def undo_row(history: Sequence[Row], stamp: Stamp) -> Row:
    """Return the revision that undoes the last change of a history."""
    restores, row = undone(history)
    if row is None or row.value is None:
        return deletion_row(history[-1], stamp, restores=restores)
    draft = Draft(kind=row.kind, name=row.name, value=row.value, tags=row.tags)
    return next_row(draft, history[-1], stamp, restores=restores)


def _origin(revision: int, rows: Mapping[int, Row]) -> int:
    """Return the revision that first had the content of `revision`; 0 before the first."""
    while revision in rows and (restored := rows[revision].restores) is not None:
        revision = restored
    return revision if revision in rows else 0
