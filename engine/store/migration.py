"""Copies all entries with their histories from one store to another, and verifies that they arrived."""

from __future__ import annotations

import hashlib
from collections.abc import Callable

import msgspec

from engine.errors import StoreError
from engine.store.contract import Store

_BATCH = 200


class Migration(msgspec.Struct, frozen=True, kw_only=True):
    """What was copied: `digest` is that of all changes, the same in both stores."""

    entries: int
    changes: int
    new_changes: int
    digest: str


async def migrate(source: Store, target: Store, *, progress: Callable[[int, int], None] | None = None) -> Migration:
    """Copy every entry of `source`, deleted ones too, with its whole history.

    May be repeated: what is there already is only compared, and what was changed since is added.

    Args:
        source: Is only read.
        target: Takes the entries; what it has besides stays.
        progress: Called with the entries done and those there are.

    Raises:
        EntryConflict: an entry has another history in `target`.
        StoreError: `target` does not give back what was written, or `source` was changed meanwhile.
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
                f"after the migration it has {len(ours)} revisions there and {len(theirs)} here, or they differ",
                where=f"{kind} {name}",
                hint="if it was changed meanwhile, migrate again",
            )
        if ours[-1].value is not None and (await target.get(kind, name)).value != ours[-1].value:
            raise StoreError("its last revision is not what it shows", where=f"{kind} {name}", hint="report this")
        digest.update(msgspec.json.encode(ours))
        count += len(ours)
    return count, digest.hexdigest()
