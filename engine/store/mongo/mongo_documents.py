"""The MongoDB documents of entries and their revisions.

    entry:  {_id: "joints home", kind, name, revision, value: {…}, tags, words, changed, by, reason, …}
    change: {_id: "joints home 3", kind, name, revision, value: {…} or null, tags, changed, by, reason, …}

A value is a plain document that any client of MongoDB can read. A value that BSON would change
or make too large is stored as JSON text in `value_json`.
"""

from __future__ import annotations

from collections.abc import Mapping
from datetime import UTC, datetime, timedelta
from typing import Any, cast

import bson
from bson.codec_options import CodecOptions
from bson.errors import BSONError

from engine.store.limits import decode_value, encode_value
from engine.store.rows import RevisionRow
from engine.store.search_terms import prefixes_of, terms_of

Document = dict[str, Any]
MAX_BSON_BYTES = 12 * 1024 * 1024
"""Size from which a value is stored as JSON, well below MongoDB's limit of 16 MiB."""
_EPOCH = datetime(1970, 1, 1, tzinfo=UTC)
OPTIONS: CodecOptions[Document] = CodecOptions(tz_aware=True)


def entry_id(kind: str, name: str) -> str:
    """Return the id of an entry's document."""
    return f"{kind} {name}"


def change_id(row: RevisionRow) -> str:
    """Return the id of the document of a revision; it is unique, so two writers of one revision collide."""
    return f"{row.kind} {row.name} {row.revision}"


def change_document(row: RevisionRow, *, write: str) -> Document:
    """Return a revision as a document; `write` identifies the write operation that inserted it."""
    return {"_id": change_id(row), **_common(row), "write": write}


def entry_document(row: RevisionRow) -> Document:
    """Return an entry as a document; the document of a deleted entry is kept for its revision."""
    words = terms_of(row.name, row.tags) if row.value is not None else ()
    return {
        "_id": entry_id(row.kind, row.name),
        **_common(row),
        "deleted": row.value is None,
        "words": list(words),
        "starts": list(prefixes_of(words)),
    }


def row_from_document(document: Mapping[str, Any]) -> RevisionRow:
    """Return the revision in a document of either collection."""
    return RevisionRow(
        kind=document["kind"],
        name=document["name"],
        revision=int(document["revision"]),
        value=_value(document),
        tags=tuple(document.get("tags", ())),
        changed_unix_ms=_unix_ms(document.get("changed")),
        by=document.get("by", ""),
        reason=document.get("reason", ""),
        restores=None if document.get("restores") is None else int(document["restores"]),
        writer=document.get("writer", ""),
    )


def _common(row: RevisionRow) -> Document:
    return {
        "kind": row.kind,
        "name": row.name,
        "revision": row.revision,
        **_stored_value(row.value, where=f"{row.kind} {row.name}"),
        "tags": list(row.tags),
        "changed": _EPOCH + timedelta(milliseconds=row.changed_unix_ms),
        "by": row.by,
        "reason": row.reason,
        "restores": row.restores,
        "writer": row.writer,
    }


def _stored_value(value: str | None, *, where: str) -> Document:
    if value is None:
        return {"value": None}
    plain = decode_value(value, where=where)
    try:
        data = bson.encode({"value": plain})
    except (BSONError, ValueError, OverflowError):
        return {"value_json": value}
    # Keys such as $ref have a meaning in BSON and are decoded to other types.
    if len(data) > MAX_BSON_BYTES or _plain(_read(data)["value"]) != plain:
        return {"value_json": value}
    return {"value": plain}


def _read(data: bytes) -> Document:
    # The type stubs of bson refer to a type that they do not define.
    decode: Any = bson.decode  # pyright: ignore[reportUnknownMemberType, reportUnknownVariableType]
    return cast("Document", decode(data, OPTIONS))


def _value(document: Mapping[str, Any]) -> str | None:
    if "value_json" in document:
        return cast("str", document["value_json"])
    value = document.get("value")
    where = f"{document['kind']} {document['name']}"
    return None if value is None else encode_value(_plain(value), where=where)


def _plain(value: Any) -> Any:
    """Convert lists, objects and numbers of BSON to those of Python."""
    if isinstance(value, dict):
        return {key: _plain(inner) for key, inner in cast("dict[str, Any]", value).items()}
    if isinstance(value, list):
        return [_plain(inner) for inner in cast("list[Any]", value)]
    return int(value) if type(value) is bson.Int64 else value


def _unix_ms(moment: datetime | None) -> int:
    if moment is None:
        return 0
    aware = moment if moment.tzinfo is not None else moment.replace(tzinfo=UTC)
    return round((aware - _EPOCH) / timedelta(milliseconds=1))
