"""Copies all entries with their histories from one store to another and verifies the copy."""

from __future__ import annotations

import hashlib
from collections.abc import Callable

import msgspec

from engine.errors import StoreError
from engine.store.contract import Store

_BATCH = 200


class Migration(msgspec.Struct, frozen=True, kw_only=True):
    """The result of a migration: `digest` is the SHA-256 of all changes, equal in both stores."""

    entries: int
    changes: int
    new_changes: int
    digest: str


async def migrate(source: Store, target: Store, *, progress: Callable[[int, int], None] | None = None) -> Migration:
    """Copy every entry of `source`, including deleted ones, with its whole history.

    May be repeated: existing changes are only compared, and new changes are added.

    Args:
        source: Only read.
        target: Receives the entries; its other entries are kept.
        progress: Called with the number of copied entries and the total number.

    Raises:
        EntryConflict: an entry has another history in `target`.
        StoreError: `target` does not return what was written, or `source` changed during the migration.
    """
    names = await source.all_names()
    new = 0
    for at in range(0, len(names), _BATCH):
        new += await target.import_histories(
            [await source.history(kind, name) for kind, name in names[at : at + _BATCH]]
        )
        if progress is not None:
            progress(min(at + _BATCH, len(names)), len(names))
    changes, digest = await _verify(source, target, names)
    return Migration(entries=len(names), changes=changes, new_changes=new, digest=digest)


async def _verify(source: Store, target: Store, names: tuple[tuple[str, str], ...]) -> tuple[int, str]:
    digest, count = hashlib.sha256(), 0
    for kind, name in names:
        theirs, ours = await source.history(kind, name), await target.history(kind, name)
        if theirs != ours:
            raise StoreError(
                f"the revisions differ: {len(ours)} in the target, {len(theirs)} in the source",
                where=f"{kind} {name}",
                hint="if the entry was changed during the migration, migrate again",
            )
        if ours[-1].value is not None and (await target.get(kind, name)).value != ours[-1].value:
            raise StoreError(
                "the value of the entry differs from its last revision",
                where=f"{kind} {name}",
                hint="report this defect",
            )
        digest.update(msgspec.json.encode(ours))
        count += len(ours)
    return count, digest.hexdigest()
