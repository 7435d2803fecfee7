"""Opens the store that the options of a command select."""

from __future__ import annotations

import asyncio
import getpass
from collections.abc import Awaitable, Callable
from pathlib import Path
from typing import Annotated, TypeVar

import typer

from engine.cell.cell_store import open_cell_store
from engine.document.cell import load_cell
from engine.document.entries_document import load_entries
from engine.errors import StoreError
from engine.store import Store, open_store
from engine.store.mongo.mongo_address import is_mongo_address

T = TypeVar("T")

Cell = Annotated[Path | None, typer.Option("--cell", help="Cell whose store is used.")]
Place = Annotated[
    str | None, typer.Option("--store", help="Store file or mongodb://HOST:PORT/DATABASE, instead of a cell.")
]


def author_name(who: str | None) -> str:
    """Return the author of a change: the name given, else the user name of the process if there is one."""
    if who is not None:
        return who
    try:
        return getpass.getuser()
    except (KeyError, OSError):
        return ""


Who = Annotated[str | None, typer.Option(help="Author of the change, for the history; by default your user name.")]
Why = Annotated[str, typer.Option(help="Reason of the change, for the history.")]


def with_store(cell: Path | None, address: str | None, work: Callable[[Store], Awaitable[T]]) -> T:
    """Open the selected store, call `work` with it, and close it."""

    async def main() -> T:
        async with await chosen_store(cell, address, inline=True) as opened:
            return await work(opened)

    return asyncio.run(main())


async def chosen_store(cell: Path | None, address: str | None, *, inline: bool) -> Store:
    """Open the store at an address, else the store of a cell, seeded.

    Raises:
        StoreError: neither is given, the cell has no store, or the store cannot be opened.
    """
    if address is not None:
        return await open_store(address, inline=inline)
    if cell is None:
        raise StoreError("no store is selected", hint="give --cell FILE or --store ADDRESS")
    return await _of_cell(cell, inline=inline)


async def opened_store(text: str, *, made: bool) -> Store:
    """Open the store at an address, or that of a cell document; a missing file is created only if `made`.

    Raises:
        StoreError: the store cannot be opened.
    """
    if text.endswith((".yaml", ".yml")):
        return await _of_cell(Path(text), inline=True)
    if not made:
        require_file(text)
    return await open_store(text, inline=True)


def require_file(address: str) -> None:
    """Raise StoreError for the path of a missing file, which opening the store would create."""
    if not is_mongo_address(address) and not Path(address).is_file():
        raise StoreError("there is no such store file", where=address)


async def _of_cell(file: Path, *, inline: bool) -> Store:
    loaded = load_cell(file)
    opened = await open_cell_store(loaded, inline=inline)
    if loaded.seed_file is not None:
        try:
            await opened.seed(load_entries(loaded.seed_file).records(), by=f"cell {loaded.name}")
        except BaseException:
            # The store must be closed for every reason for which seeding ends early.
            await opened.close()
            raise
    return opened
