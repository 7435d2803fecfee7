"""An optional disk cache of slow mesh conversions: validated on read, rebuilt when damaged."""

from __future__ import annotations

import hashlib
import logging
import os
import tempfile
from pathlib import Path

_log = logging.getLogger("flexcell.meshes")
_DIGEST = 32


def content_key(data: bytes, *, recipe: str) -> str:
    """Return the cache key of the result of `recipe` on `data`."""
    return hashlib.sha256(recipe.encode() + b"\0" + data).hexdigest()


def read_cached(folder: Path, key: str) -> bytes | None:
    """Return the entry under `key`, None if it is missing or damaged."""
    try:
        content = (folder / key).read_bytes()
    except OSError:
        return None
    digest, payload = content[:_DIGEST], content[_DIGEST:]
    if hashlib.sha256(payload).digest() != digest:
        _log.warning("the cached file %s is damaged and is rebuilt", folder / key)
        return None
    return payload


def write_cached(folder: Path, key: str, payload: bytes) -> None:
    """Store `payload` under `key` atomically; an unwritable folder is ignored."""
    try:
        folder.mkdir(parents=True, exist_ok=True)
        handle, temporary = tempfile.mkstemp(dir=folder)
        try:
            with os.fdopen(handle, "wb") as file:
                file.write(hashlib.sha256(payload).digest() + payload)
            Path(temporary).replace(folder / key)
        except BaseException:
            # No partial file may remain after any interruption.
            Path(temporary).unlink(missing_ok=True)
            raise
    except OSError as error:
        _log.info("meshes are not cached in %s: %s", folder, error)
