"""The store of a cell: the store of its document, or a replacement."""

from __future__ import annotations

from pathlib import Path

from engine.document.cell import Cell
from engine.document.cell_store_spec import MongoStoreSpec
from engine.errors import CellError
from engine.store import Store, open_store
from engine.store.mongo.mongo_address import is_mongo_address, public_address


def store_address(cell: Cell, instead: str | None = None) -> str | None:
    """Return the path or address of a cell's store without secrets; None when the cell has no store."""
    named = cell.document.store
    if named is None:
        return None
    if instead is not None:
        return public_address(instead, _database(instead)) if is_mongo_address(instead) else instead
    return public_address(named.uri, named.database) if isinstance(named, MongoStoreSpec) else named.path


def absolute_address(address: str) -> str:
    """Return an address that is independent of the working directory."""
    return address if is_mongo_address(address) else str(Path(address).resolve())


async def open_cell_store(cell: Cell, instead: str | None = None, *, inline: bool = False) -> Store:
    """Open the store of a cell.

    Args:
        cell: The cell.
        instead: A file or address that replaces the store. The cell's own address without secrets selects its store.
        inline: Work on the calling thread, for runs in virtual time.

    Raises:
        CellError: the cell has no store.
        StoreError: the store cannot be opened.
    """
    named = cell.document.store
    if named is None:
        raise CellError("this cell has no store", where=cell.file, hint="add `store: {kind: sqlite, path: …}`")
    if instead is not None and instead != store_address(cell):
        return await open_store(instead, inline=inline)
    if isinstance(named, MongoStoreSpec):
        return await open_store(named.uri, database=named.database, inline=inline)
    return await open_store(named.path, inline=inline)


def _database(uri: str) -> str:
    return uri.split("://", 1)[1].partition("/")[2].split("?", 1)[0]
