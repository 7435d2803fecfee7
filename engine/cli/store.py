"""`flexcell store`: reads and writes the named entries of a cell."""

from __future__ import annotations

import asyncio
import sys
from collections.abc import Awaitable, Callable
from pathlib import Path
from typing import Annotated, TypeVar

import msgspec
import typer
from rich.console import Console
from rich.table import Table

from engine.cli.inputs import read_json
from engine.document.cell import load_cell
from engine.document.entries import load_entries, write_entries
from engine.errors import StoreError
from engine.skills.entries import EntryRecord
from engine.store import SqliteStore, Store

T = TypeVar("T")

app = typer.Typer(help="Read and write the named entries of a cell: joint configurations, poses, records.")

Cell = Annotated[Path | None, typer.Option("--cell", help="The cell whose store it is.")]
File = Annotated[Path | None, typer.Option("--store", help="A store file, instead of a cell.")]
Kind = Annotated[str, typer.Argument(help="joints, pose, dmp or record.")]
Name = Annotated[str, typer.Argument(help="Name of the entry.")]
AsJson = Annotated[bool, typer.Option("--json", help="Print JSON.")]


@app.command("list")
def list_entries(
    kind: Annotated[str, typer.Argument(help="Only this kind.")] = "",
    prefix: Annotated[str, typer.Option(help="Only names that begin so.")] = "",
    cell: Cell = None,
    store: File = None,
    json: AsJson = False,
) -> None:
    """List the entries with their revisions."""
    keys = _with_store(cell, store, lambda opened: opened.list(kind=kind, prefix=prefix))
    if json:
        sys.stdout.write(msgspec.json.encode(keys).decode() + "\n")
        return
    table = Table("kind", "name", "revision", box=None)
    for key in keys:
        table.add_row(key.kind, key.name, str(key.revision))
    Console().print(table)


@app.command("get")
def get(kind: Kind, name: Name, cell: Cell = None, store: File = None) -> None:
    """Print one entry as JSON."""
    record = _with_store(cell, store, lambda opened: opened.get(kind, name))
    sys.stdout.write(msgspec.json.encode(record).decode() + "\n")


@app.command("set")
def set_entry(
    kind: Kind,
    name: Name,
    value: Annotated[str, typer.Argument(help="The fields of its kind as a JSON object.")],
    expected_revision: Annotated[
        int | None, typer.Option(help="Write only when the stored entry has this revision; 0: only when there is none.")
    ] = None,
    cell: Cell = None,
    store: File = None,
) -> None:
    """Write one entry."""
    fields = read_json(value, "the value")
    if not isinstance(fields, dict):
        raise StoreError("the value is not a JSON object", where=f"{kind} {name}", hint='such as {"joints": [0, 1]}')
    checked = msgspec.convert(fields, dict[str, object])
    record = _with_store(
        cell, store, lambda opened: opened.put(kind, name, checked, expected_revision=expected_revision)
    )
    sys.stdout.write(f"{record.kind} {record.name} revision {record.revision}\n")


@app.command("delete")
def delete(kind: Kind, name: Name, cell: Cell = None, store: File = None) -> None:
    """Remove one entry; its history stays."""
    _with_store(cell, store, lambda opened: opened.delete(kind, name))


@app.command("export")
def export(cell: Cell = None, store: File = None) -> None:
    """Print all entries as an entries document."""
    records = _with_store(cell, store, lambda opened: opened.export())
    sys.stdout.write(write_entries(records))


@app.command("import")
def import_entries(
    file: Annotated[Path, typer.Argument(help="An entries document.")],
    overwrite: Annotated[bool, typer.Option(help="Write also entries that are there with another value.")] = False,
    cell: Cell = None,
    store: File = None,
) -> None:
    """Write the entries of a document that are missing in the store."""
    entries = load_entries(file).records()
    written = _with_store(cell, store, lambda opened: opened.seed(entries, overwrite=overwrite))
    sys.stdout.write(f"{len(written)} of {len(entries)} entries written\n")


def _with_store(cell: Path | None, file: Path | None, work: Callable[[Store], Awaitable[T]]) -> T:
    path, seeds = _store_of(cell, file)

    async def main() -> T:
        async with SqliteStore.open(path, inline=True) as opened:
            await opened.seed(seeds)
            return await work(opened)

    return asyncio.run(main())


def _store_of(cell: Path | None, file: Path | None) -> tuple[Path, tuple[EntryRecord, ...]]:
    if file is not None:
        return file, ()
    if cell is None:
        raise StoreError("which store?", hint="give --cell FILE or --store FILE")
    loaded = load_cell(cell)
    if loaded.document.store is None:
        raise StoreError("this cell has no store", where=cell, hint="add `store: {kind: sqlite, path: …}`")
    seeds = load_entries(loaded.seed_file).records() if loaded.seed_file is not None else ()
    return Path(loaded.document.store.path), seeds
