"""Reads documents of `mongodb_store` from files and servers, and makes their values plain."""

from __future__ import annotations

import base64
import json
import math
from collections.abc import Iterable, Iterator, Mapping
from datetime import datetime
from importlib import import_module
from pathlib import Path
from typing import Any, cast

from engine.errors import StoreError

_NUMBERS = {"$numberInt": int, "$numberLong": int, "$numberDouble": float, "$numberDecimal": float}


def read_ros_file(path: Path) -> tuple[dict[str, Any], ...]:
    """Return the documents in a file of `mongoexport` (JSON lines or an array) or `mongodump` (`.bson`).

    Raises:
        StoreError: it cannot be read, or is neither.
    """
    try:
        if path.suffix == ".bson":
            return tuple(_bson_documents(path))
        return tuple(_json_documents(path.read_text(encoding="utf-8")))
    except (OSError, ValueError) as error:
        raise StoreError(
            f"the documents cannot be read: {error}", where=path, hint="give the output of mongoexport or mongodump"
        ) from error


def read_ros_documents(documents: Iterable[Mapping[str, Any]]) -> Iterator[dict[str, Any]]:
    """Return documents as they come from a server as plain objects."""
    for document in documents:
        yield cast("dict[str, Any]", plain(document))


def plain(value: Any) -> Any:
    """Return a value of BSON or of MongoDB's extended JSON with numbers, text, lists and objects only.

    Bytes become `{base64: …}`, times ISO text, ids text; numbers that are not finite become text.
    """
    if isinstance(value, Mapping):
        return _plain_object(cast("Mapping[str, Any]", value))
    if isinstance(value, (list, tuple)):
        return [plain(inner) for inner in cast("list[Any]", value)]
    if isinstance(value, float):
        return value if math.isfinite(value) else str(value)
    if isinstance(value, bytes):
        return {"base64": base64.b64encode(value).decode()}
    if isinstance(value, datetime):
        return value.isoformat()
    if value is None or isinstance(value, (bool, str)):
        return value
    return int(value) if isinstance(value, int) else str(value)


def _plain_object(value: Mapping[str, Any]) -> Any:
    if len(value) == 1:
        ((key, inner),) = value.items()
        if key in _NUMBERS:
            return plain(_NUMBERS[key](inner))
        if key == "$oid":
            return str(inner)
        if key == "$date":
            return inner if isinstance(inner, str) else plain(inner)
        if key == "$binary" and isinstance(inner, Mapping):
            return {"base64": str(cast("Mapping[str, Any]", inner).get("base64", ""))}
    if set(value) == {"$binary", "$type"}:
        return {"base64": str(value["$binary"])}
    return {str(key): plain(inner) for key, inner in value.items()}


def _json_documents(text: str) -> Iterator[dict[str, Any]]:
    decoder = json.JSONDecoder()
    at = 0
    while at < len(text):
        if text[at].isspace():
            at += 1
            continue
        found, at = decoder.raw_decode(text, at)
        for document in cast("list[Any]", found) if isinstance(found, list) else [found]:
            if not isinstance(document, dict):
                raise ValueError(f"{document!r:.60} is no document")
            yield cast("dict[str, Any]", plain(document))


def _bson_documents(path: Path) -> Iterator[dict[str, Any]]:
    try:
        bson: Any = import_module("bson")
    except ImportError as error:
        raise StoreError(
            "reading .bson needs the package pymongo", where=path, hint="pip install 'flexcell[mongo]'"
        ) from error
    try:
        with path.open("rb") as file:
            yield from read_ros_documents(bson.decode_file_iter(file))
    except bson.errors.InvalidBSON as error:
        raise ValueError(str(error)) from error
