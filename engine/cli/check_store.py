"""Lists the named entries that a run of a behavior finds in a store, for `flexcell check --store`."""

from __future__ import annotations

import asyncio
from pathlib import Path

from engine.cell.cell_store import open_cell_store
from engine.check import names_by_kind
from engine.cli.store_access import require_file
from engine.document import Behavior
from engine.document.cell import load_cell
from engine.document.cell_store_spec import MongoStoreSpec
from engine.document.entries_document import load_entries
from engine.errors import DocumentError
from engine.store import Store, open_store

OWN = "cell"
"""Name of the store of the behavior's own cell."""


def stored_names(behavior: Behavior, store: str) -> dict[str, set[str]]:
    """Return, by kind, the names of the entries in a store and of those that the cell seeds it with.

    Args:
        behavior: The behavior that names the cell.
        store: A file, the address of a MongoDB server, or `cell`.

    Raises:
        DocumentError: the behavior names no cell with a store.
        StoreError: the store cannot be opened.
    """
    cell = load_cell(behavior.cell_file) if behavior.cell_file is not None else None
    keys: list[tuple[str, str]] = []
    if cell is not None and cell.seed_file is not None:
        keys += [(record.kind, record.name) for record in load_entries(cell.seed_file).records()]
    if store != OWN:
        return names_by_kind([*keys, *_keys(store)])
    if cell is None or cell.document.store is None:
        raise DocumentError(
            "the behavior names no cell with a store", where=behavior.file, hint="name one: --store FILE or mongodb://…"
        )
    named = cell.document.store
    if isinstance(named, MongoStoreSpec) or Path(named.path).is_file():
        return names_by_kind([*keys, *asyncio.run(_listed_of_cell(behavior))])
    # A store file that does not exist yet is created with the seed entries.
    return names_by_kind(keys)


def _keys(address: str) -> list[tuple[str, str]]:
    require_file(address)
    return asyncio.run(_listed(address))


async def _listed(address: str) -> list[tuple[str, str]]:
    async with await open_store(address, inline=True) as store:
        return await _names(store)


async def _listed_of_cell(behavior: Behavior) -> list[tuple[str, str]]:
    assert behavior.cell_file is not None
    async with await open_cell_store(load_cell(behavior.cell_file), inline=True) as store:
        return await _names(store)


async def _names(store: Store) -> list[tuple[str, str]]:
    return [(key.kind, key.name) for key in await store.list()]
