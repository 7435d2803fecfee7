"""The store of a run of a sweep: a copy of the cell's, with the seed entries of the cell where it has none."""

from __future__ import annotations

import sqlite3
import tempfile
from contextlib import closing
from hashlib import sha256
from pathlib import Path

import msgspec

from engine.cell.cell_store import open_cell_store
from engine.clock import run_virtual
from engine.document.cell import Cell
from engine.document.entries_document import load_entries
from engine.project.headless_run import outside_loop


def copied_store(file: Path | None, folder: Path) -> Path:
    """Return the file of a store of one run alone: a copy of the store, or a new one for the seed entries."""
    copy = folder / "store.db"
    if file is not None:
        address = f"{file.absolute().as_uri()}?mode=ro"
        with closing(sqlite3.connect(address, uri=True)) as stored, closing(sqlite3.connect(copy)) as copied:
            stored.backup(copied)
    return copy


def entries_hash(cell: Cell, file: Path | None) -> str:
    """Return the hash of the entries that a run finds, with the numbers of their revisions.

    A store that was opened, and has nothing but the seed entries, has the hash of a cell without a store file.

    Args:
        cell: The cell; without a store there are no entries.
        file: The file of the store; None if there is none yet.

    Raises:
        StoreError: the store cannot be read.
        DocumentError: the seed entries cannot be read.
    """
    if cell.document.store is None:
        return ""
    with tempfile.TemporaryDirectory(prefix="flexcell-sweep-") as folder:
        copy = copied_store(file, Path(folder))
        return outside_loop(lambda: run_virtual(_hash_of_entries(cell, copy)))


async def _hash_of_entries(cell: Cell, copy: Path) -> str:
    async with await open_cell_store(cell, str(copy), inline=True) as store:
        if cell.seed_file is not None:
            await store.seed(load_entries(cell.seed_file).records())
        return sha256(msgspec.json.encode(await store.export(), order="deterministic")).hexdigest()
