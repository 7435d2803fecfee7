"""Data exchanged between a store and its database: revision rows with JSON values, drafts, stamps and queries."""

from __future__ import annotations

import msgspec


class RevisionRow(msgspec.Struct, frozen=True, kw_only=True):
    """One revision of an entry as stored.

    `value` is JSON with sorted keys, None for a deletion (and when values were not requested).
    `restores` is the revision whose content it restored, 0 for no entry; None when it is not an
    undo. `writer` identifies the open store that committed it.
    """

    kind: str
    name: str
    revision: int
    value: str | None
    tags: tuple[str, ...] = ()
    changed_unix_ms: int = 0
    by: str = ""
    reason: str = ""
    restores: int | None = None
    writer: str = ""


class ChangeStamp(msgspec.Struct, frozen=True, kw_only=True):
    """Author, reason, time and open store of a change."""

    by: str = ""
    reason: str = ""
    changed_unix_ms: int = 0
    writer: str = ""


class EntryDraft(msgspec.Struct, frozen=True, kw_only=True):
    """An entry to be written; `tags` None keeps the present tags."""

    kind: str
    name: str
    value: str
    tags: tuple[str, ...] | None = None


class EntryQuery(msgspec.Struct, frozen=True, kw_only=True):
    """A query for entries; all conditions must hold, an empty one always holds.

    `words` are beginnings of words of the name or of tags. `after` is the kind and name of the last
    entry of the previous page, `limit` the maximum number of entries.
    """

    kind: str = ""
    prefix: str = ""
    tags: tuple[str, ...] = ()
    words: tuple[str, ...] = ()
    after: tuple[str, str] | None = None
    limit: int | None = None


def next_row(
    draft: EntryDraft, last: RevisionRow | None, stamp: ChangeStamp, *, restores: int | None = None
) -> RevisionRow:
    """Return the revision that writes a draft after `last`, which may be a deletion."""
    kept = last.tags if last is not None and last.value is not None else ()
    return RevisionRow(
        kind=draft.kind,
        name=draft.name,
        revision=(last.revision if last is not None else 0) + 1,
        value=draft.value,
        tags=kept if draft.tags is None else draft.tags,
        restores=restores,
        **msgspec.structs.asdict(stamp),
    )


def deletion_row(last: RevisionRow, stamp: ChangeStamp, *, restores: int | None = None) -> RevisionRow:
    """Return the revision that deletes the entry whose last revision is `last`."""
    return RevisionRow(
        kind=last.kind,
        name=last.name,
        revision=last.revision + 1,
        value=None,
        restores=restores,
        **msgspec.structs.asdict(stamp),
    )


def needs_seeding(draft: EntryDraft, last: RevisionRow | None, *, overwrite: bool) -> bool:
    """Return whether seeding writes a draft: it is missing, or differs and may be overwritten."""
    if last is None or last.value is None:
        return True
    return overwrite and (last.value != draft.value or (draft.tags is not None and last.tags != draft.tags))
