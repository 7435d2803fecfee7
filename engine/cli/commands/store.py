"""`flexcell store`: reads and writes the named entries of a cell."""

from __future__ import annotations

import asyncio
import sys
from datetime import UTC, datetime
from pathlib import Path
from typing import Annotated, Literal

import msgspec
import typer
from rich.console import Console
from rich.table import Table

from engine.cli.inputs import read_json
from engine.cli.store_access import Cell, Place, Who, Why, author_name, chosen_store, opened_store, with_store
from engine.cli.store_formats import exported, imported
from engine.document.text.yaml_writer import write_yaml
from engine.errors import StoreError
from engine.store import EntryChange, Store, migrate

app = typer.Typer(help="Read and write named entries of a cell: joint configurations, poses, primitives, records.")

Kind = Annotated[
    str, typer.Argument(help="Kind: joints, pose, dmp, cart_dmp, trajectory, gripper, detection, record …")
]
Name = Annotated[str, typer.Argument(help="Name of the entry.")]
AsJson = Annotated[bool, typer.Option("--json", help="Print JSON.")]
Expected = Annotated[
    int | None, typer.Option(help="Proceed only if the stored entry has this revision; 0: only if there is no entry.")
]
Format = Annotated[
    Literal["entries", "mongodb_store"],
    typer.Option("--format", help="entries: a flexcell document. mongodb_store: documents of that ROS package."),
]


@app.command("list")
def list_entries(
    kind: Annotated[str, typer.Argument(help="List only entries of this kind.")] = "",
    prefix: Annotated[str, typer.Option(help="List only names that begin with this text.")] = "",
    search: Annotated[
        str, typer.Option(help="List only entries whose name or tags contain words that begin with each of these.")
    ] = "",
    tag: Annotated[list[str] | None, typer.Option(help="List only entries with this tag; may be repeated.")] = None,
    limit: Annotated[int | None, typer.Option(help="Maximum number of entries listed.", min=1)] = None,
    cell: Cell = None,
    store: Place = None,
    json: AsJson = False,
) -> None:
    """List the entries with revision, tags, and time and author of the last change."""
    keys = with_store(
        cell,
        store,
        lambda opened: opened.list(kind=kind, prefix=prefix, text=search, tags=tag or (), limit=limit),
    )
    if json:
        sys.stdout.write(msgspec.json.encode(keys).decode() + "\n")
        return
    table = Table("kind", "name", "revision", "tags", "changed", "by", box=None)
    for key in keys:
        table.add_row(
            key.kind, key.name, str(key.revision), " ".join(key.tags), _time_text(key.changed_unix_ms), key.by
        )
    Console().print(table)


@app.command("get")
def get(kind: Kind, name: Name, cell: Cell = None, store: Place = None) -> None:
    """Print one entry as JSON."""
    record = with_store(cell, store, lambda opened: opened.get(kind, name))
    sys.stdout.write(msgspec.json.encode(record).decode() + "\n")


@app.command("show")
def show(kind: Kind, name: Name, cell: Cell = None, store: Place = None) -> None:
    """Print one entry in readable form: value, tags and last change."""
    changes = with_store(cell, store, lambda opened: opened.history(kind, name))
    if not changes or changes[-1].value is None:
        raise StoreError(
            "there is no such entry", where=f"{kind} {name}", hint="`flexcell store list` lists the entries"
        )
    last = changes[-1]
    sys.stdout.write(f"{last.kind} {last.name}, {_change_text(last)}\n")
    if last.tags:
        sys.stdout.write(f"tags: {' '.join(last.tags)}\n")
    sys.stdout.write(write_yaml(last.value or {}))


@app.command("set")
def set_entry(
    kind: Kind,
    name: Name,
    value: Annotated[str, typer.Argument(help="Fields of the entry as a JSON object.")],
    expected_revision: Expected = None,
    tag: Annotated[list[str] | None, typer.Option(help="Tag, replaces the present tags; may be repeated.")] = None,
    by: Who = None,
    reason: Why = "",
    cell: Cell = None,
    store: Place = None,
) -> None:
    """Write one entry."""
    fields = read_json(value, "the value")
    if not isinstance(fields, dict):
        raise StoreError("the value is not a JSON object", where=f"{kind} {name}", hint='such as {"joints": [0, 1]}')
    checked = msgspec.convert(fields, dict[str, object])
    record = with_store(
        cell,
        store,
        lambda opened: opened.put(
            kind, name, checked, expected_revision=expected_revision, tags=tag, by=author_name(by), reason=reason
        ),
    )
    sys.stdout.write(f"{record.kind} {record.name} revision {record.revision}\n")


@app.command("delete")
def delete(
    kind: Kind,
    name: Name,
    expected_revision: Expected = None,
    by: Who = None,
    reason: Why = "",
    cell: Cell = None,
    store: Place = None,
) -> None:
    """Delete one entry; its history is kept, and `undo` restores it."""
    with_store(
        cell,
        store,
        lambda opened: opened.delete(
            kind, name, expected_revision=expected_revision, by=author_name(by), reason=reason
        ),
    )


@app.command("history")
def history(kind: Kind, name: Name, cell: Cell = None, store: Place = None, json: AsJson = False) -> None:
    """Print every change of an entry: author, time and reason; with --json also the values."""
    changes = with_store(cell, store, lambda opened: opened.history(kind, name))
    if json:
        sys.stdout.write(msgspec.json.encode(changes).decode() + "\n")
        return
    for change in changes:
        sys.stdout.write(f"{_change_text(change)}\n")


@app.command("undo")
def undo(
    kind: Kind,
    name: Name,
    expected_revision: Expected = None,
    by: Who = None,
    reason: Why = "",
    cell: Cell = None,
    store: Place = None,
) -> None:
    """Restore an entry to its state before the last change; repeated, one change further back."""
    change = with_store(
        cell,
        store,
        lambda opened: opened.undo(kind, name, expected_revision=expected_revision, by=author_name(by), reason=reason),
    )
    sys.stdout.write(f"{change.kind} {change.name} {_change_text(change)}\n")


@app.command("export")
def export(format_: Format = "entries", cell: Cell = None, store: Place = None) -> None:
    """Print all entries, as an entries document or as one JSON document per line for `mongoimport`."""
    records = with_store(cell, store, lambda opened: opened.export())
    sys.stdout.write(exported(records, format_))


@app.command("import")
def import_entries(
    source: Annotated[
        str,
        typer.Argument(help="Entries document; with --format mongodb_store: a .json or .bson file, or mongodb://…."),
    ],
    overwrite: Annotated[bool, typer.Option(help="Also overwrite stored entries that have another value.")] = False,
    format_: Format = "entries",
    collection: Annotated[str, typer.Option(help="Collection of a mongodb:// source.")] = "message_store",
    by: Who = None,
    cell: Cell = None,
    store: Place = None,
) -> None:
    """Import the entries of a document that are missing in the store."""
    entries = imported(source, format_, collection=collection, say=_print_message)
    written = with_store(
        cell,
        store,
        lambda opened: opened.seed(
            entries, overwrite=overwrite, by=author_name(by), reason=f"import of {Path(source).name}"
        ),
    )
    sys.stdout.write(f"{len(written)} of {len(entries)} entries written\n")


@app.command("migrate")
def migrate_store(
    source: Annotated[str, typer.Argument(help="Store file, mongodb://HOST:PORT/DATABASE, or cell document.")],
    target: Annotated[str, typer.Argument(help="As SOURCE; it is created if missing.")],
) -> None:
    """Copy all entries with their histories to another store, and verify the copy; may be repeated."""

    async def main() -> None:
        async with (
            await opened_store(source, made=False) as source_store,
            await opened_store(target, made=True) as target_store,
        ):
            done = await migrate(
                source_store, target_store, progress=lambda n, of: _print_message(f"{n} of {of} entries")
            )
            sys.stdout.write(
                f"{done.entries} entries with {done.changes} changes are in {target_store.address},"
                f" {done.new_changes} new; verified, digest {done.digest[:16]}\n"
            )

    asyncio.run(main())


@app.command("watch")
def watch(
    count: Annotated[int | None, typer.Option(help="Number of changes to print; default: until Ctrl-C.", min=1)] = None,
    cell: Cell = None,
    store: Place = None,
    json: AsJson = False,
) -> None:
    """Print each change of the store by any program, until Ctrl-C."""

    async def follow(opened: Store) -> None:
        changes: asyncio.Queue[EntryChange] = asyncio.Queue()
        await opened.follow(changes.put_nowait)
        _print_message(f"watching {opened.address}")
        printed = 0
        while count is None or printed < count:
            change = await changes.get()
            printed += 1
            text = msgspec.json.encode(change).decode() if json else _entry_change_text(change)
            sys.stdout.write(f"{text}\n")
            sys.stdout.flush()

    async def main() -> None:
        async with await chosen_store(cell, store, inline=False) as opened:
            await follow(opened)

    try:
        asyncio.run(main())
    except KeyboardInterrupt:
        return


def _entry_change_text(change: EntryChange) -> str:
    return f"{change.kind} {change.name} {_change_text(change)}"


def _change_text(change: EntryChange) -> str:
    action = "deleted" if change.value is None else "written"
    if change.restores is not None:
        action = f"undone to revision {change.restores}" if change.restores else "undone: deleted"
    author = f" by {change.by}" if change.by else ""
    reason = f": {change.reason}" if change.reason else ""
    return f"revision {change.revision} {action} {_time_text(change.changed_unix_ms)}{author}{reason}"


def _time_text(unix_ms: int) -> str:
    return (
        datetime.fromtimestamp(unix_ms / 1000, UTC).strftime("%Y-%m-%d %H:%M:%SZ") if unix_ms else "at an unknown time"
    )


def _print_message(line: str) -> None:
    sys.stderr.write(f"flexcell: {line}\n")
    sys.stderr.flush()
