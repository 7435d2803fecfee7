"""Reads documents of `mongodb_store` from files and servers and converts their values to plain data."""

from __future__ import annotations

import base64
import json
import math
from collections.abc import Iterable, Iterator, Mapping
from datetime import datetime
from importlib import import_module
from io import BytesIO
from itertools import islice
from pathlib import Path
from typing import Any, cast

from engine.errors import StoreError
from engine.store.limits import MAX_DEPTH

MAX_FILE = 256 * 2**20
"""Size limit of a file in bytes."""
MAX_DOCUMENTS = 100_000
"""Maximum number of documents in a file or collection."""

_NUMBERS = {"$numberInt": int, "$numberLong": int, "$numberDouble": float, "$numberDecimal": float}


def read_ros_file(path: Path) -> tuple[dict[str, Any], ...]:
    """Return the documents in a file of `mongoexport` (JSON lines or an array) or `mongodump` (`.bson`).

    Raises:
        StoreError: the file cannot be read, has another format, is too large, or has too many documents.
    """
    try:
        with path.open("rb") as file:
            content = file.read(MAX_FILE + 1)
        if len(content) > MAX_FILE:
            raise ValueError(f"the file has more than {MAX_FILE} bytes")
        found = _bson_documents(content, path) if path.suffix == ".bson" else _json_documents(content.decode())
        documents = tuple(islice(found, MAX_DOCUMENTS + 1))
        if len(documents) > MAX_DOCUMENTS:
            raise ValueError(f"there are more than {MAX_DOCUMENTS} documents")
    except (OSError, ValueError, TypeError, OverflowError, RecursionError) as error:
        # Values of MongoDB's extended JSON may have any type in place of a number.
        raise StoreError(
            f"the documents cannot be read: {error}", where=path, hint="give the output of mongoexport or mongodump"
        ) from error
    return documents


def read_ros_documents(documents: Iterable[Mapping[str, Any]]) -> Iterator[dict[str, Any]]:
    """Yield documents of a server as plain objects."""
    for document in documents:
        yield cast("dict[str, Any]", plain_bson(document))


def plain_bson(value: Any, *, depth: int = 0) -> Any:
    """Convert a value of BSON or of MongoDB's extended JSON to numbers, text, lists and objects.

    Bytes become `{base64: …}`, times ISO text, ids text; non-finite numbers become text.

    Raises:
        ValueError: the value is nested too deeply, or is not a value of either format.
    """
    if depth > MAX_DEPTH:
        raise ValueError(f"a value is nested deeper than {MAX_DEPTH} levels")
    if isinstance(value, Mapping):
        return _plain_object(cast("Mapping[str, Any]", value), depth)
    if isinstance(value, (list, tuple)):
        return [plain_bson(inner, depth=depth + 1) for inner in cast("list[Any]", value)]
    if isinstance(value, float):
        return value if math.isfinite(value) else str(value)
    if isinstance(value, bytes):
        return {"base64": base64.b64encode(value).decode()}
    if isinstance(value, datetime):
        return value.isoformat()
    if value is None or isinstance(value, (bool, str)):
        return value
    return int(value) if isinstance(value, int) else str(value)


def _plain_object(value: Mapping[str, Any], depth: int) -> Any:
    if len(value) == 1:
        ((key, inner),) = value.items()
        if key in _NUMBERS:
            return plain_bson(_NUMBERS[key](inner), depth=depth + 1)
        if key == "$oid":
            return str(inner)
        if key == "$date":
            return inner if isinstance(inner, str) else plain_bson(inner, depth=depth + 1)
        if key == "$binary" and isinstance(inner, Mapping):
            return {"base64": str(cast("Mapping[str, Any]", inner).get("base64", ""))}
    if set(value) == {"$binary", "$type"}:
        return {"base64": str(value["$binary"])}
    return {str(key): plain_bson(inner, depth=depth + 1) for key, inner in value.items()}


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
                raise TypeError(f"{document!r:.60} is not a document")
            yield cast("dict[str, Any]", plain_bson(document))


def _bson_documents(content: bytes, path: Path) -> Iterator[dict[str, Any]]:
    try:
        bson: Any = import_module("bson")
    except ImportError as error:
        raise StoreError(
            "reading .bson needs the package pymongo", where=path, hint="pip install 'flexcell[mongo]'"
        ) from error
    try:
        yield from read_ros_documents(bson.decode_file_iter(BytesIO(content)))
    except bson.errors.InvalidBSON as error:
        raise ValueError(str(error)) from error
