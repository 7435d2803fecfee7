"""Results of slow mesh conversion kept on disk, checked when read, rebuilt when damaged, optional always."""

from __future__ import annotations

import hashlib
import logging
import os
import tempfile
from pathlib import Path

_log = logging.getLogger("flexcell.meshes")
_DIGEST = 32


def cache_dir() -> Path:
    """Return the user's cache folder of this program; it need not exist."""
    base = os.environ.get("XDG_CACHE_HOME")
    return (Path(base) if base else Path.home() / ".cache") / "flexcell"


def content_key(data: bytes, *, recipe: str) -> str:
    """Return the name under which the result of `recipe` on `data` is kept."""
    return hashlib.sha256(recipe.encode() + b"\0" + data).hexdigest()


def read_cached(folder: Path, key: str) -> bytes | None:
    """Return what was kept under `key`, None when there is nothing or it is damaged."""
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
    """Keep `payload` under `key`, whole or not at all; a folder that cannot be written is left alone."""
    try:
        folder.mkdir(parents=True, exist_ok=True)
        handle, temporary = tempfile.mkstemp(dir=folder)
        try:
            with os.fdopen(handle, "wb") as file:
                file.write(hashlib.sha256(payload).digest() + payload)
            os.replace(temporary, folder / key)
        except BaseException:
            # Nothing half-written may stay behind, whatever interrupts.
            Path(temporary).unlink(missing_ok=True)
            raise
    except OSError as error:
        _log.info("meshes are not cached in %s: %s", folder, error)
