"""Reads and writes entries in the formats of `flexcell store import` and `export`."""

from __future__ import annotations

import json
from collections.abc import Callable, Sequence
from importlib import import_module
from pathlib import Path
from typing import Any

from engine.document.entries_document import load_entries, write_entries
from engine.errors import StoreError
from engine.skills.entries import EntryRecord
from engine.store.mongo.mongo_address import is_mongo_address
from engine.store.ros.ros_documents import entries_from_ros, ros_document
from engine.store.ros.ros_import import read_ros_file

ROS = "mongodb_store"


def exported(records: Sequence[EntryRecord], form: str) -> str:
    """Return entries as an entries document, or as documents of `mongodb_store`, one per line."""
    if form != ROS:
        return write_entries(records)
    return "".join(f"{json.dumps(ros_document(record), ensure_ascii=False)}\n" for record in records)


def imported(source: str, form: str, *, collection: str, say: Callable[[str], None]) -> tuple[EntryRecord, ...]:
    """Return the entries in a file or, in the format `mongodb_store`, on a server.

    `say` reports names that had to change, and messages that are imported as plain records.
    """
    if form != ROS:
        return load_entries(Path(source)).records()
    documents = _from_server(source, collection) if is_mongo_address(source) else read_ros_file(Path(source))
    entries = entries_from_ros(documents)
    for entry in entries:
        if entry.ros_name != entry.record.name:
            say(f"{entry.ros_name!r} is imported as {entry.record.name}")
        if entry.kept:
            say(f"{entry.record.name} ({entry.ros_type}) is imported as a record: {entry.kept}")
    return tuple(entry.record for entry in entries)


def _from_server(uri: str, collection: str) -> tuple[dict[str, Any], ...]:
    try:
        reading: Any = import_module("engine.store.mongo.mongo_collection")
    except ImportError as error:
        raise StoreError(
            f"reading from a server requires the package pymongo: {error}", hint="pip install 'flexcell[mongo]'"
        ) from error
    return reading.read_collection(uri, collection=collection)
