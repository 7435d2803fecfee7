"""Fixtures with the shape of a mesh file: how it is written, and the digests of the files."""

from __future__ import annotations

import hashlib
from collections.abc import Iterable, Iterator, Mapping
from functools import lru_cache
from pathlib import Path
from typing import Annotated

from msgspec import Meta

from engine.document.placement import Length
from engine.document.text.decoding import StrictModel

MESH_SUFFIXES = (".stl", ".obj", ".dae")


class Decomposition(StrictModel, frozen=True, kw_only=True):
    """How a mesh becomes convex pieces, which are what bodies touch and what planners go around."""

    parts: Annotated[int, Meta(ge=1, le=256, description="Maximum number of convex pieces")] = 64
    error_m: Annotated[
        Length, Meta(description="How far, in metres, a piece may fill a hollow of the mesh; smaller needs more pieces")
    ] = 0.005


def mesh_problems(
    shape: str, *, file: str | None, scale: float, decomposition: Decomposition | None, other: Mapping[str, bool]
) -> Iterator[tuple[str, str, str]]:
    """Yield what a fixture says that its shape does not have: the key, what is wrong, and what to do.

    Args:
        shape: Its shape.
        file: The mesh file, as written.
        scale: Metres for one unit of the file.
        decomposition: How the mesh becomes convex pieces.
        other: By key, whether it is given: keys that a mesh cannot have.
    """
    if shape != "mesh":
        given = {"file": file is not None, "scale": scale != 1.0, "decomposition": decomposition is not None}
        yield from ((key, f"a {shape} has no `{key}`", "write `shape: mesh`") for key, one in given.items() if one)
        return
    if file is None:
        yield "shape", "a mesh needs its file", "add `file: NAME.stl`, relative to this document"
    elif not file.lower().endswith(MESH_SUFFIXES):
        yield "file", f"`{file}` is no mesh file", f"give a file that ends in {', '.join(MESH_SUFFIXES)}"
    hints = {
        "size_m": "remove it: the size is that of the file; `scale: 0.001` for a file in millimetres",
        "spring": "put a sprung box beside it",
    }
    yield from ((key, f"a mesh has no `{key}`", hints[key]) for key, one in other.items() if one)


def mesh_digests(files: Iterable[str | None], folder: Path) -> dict[str, str]:
    """Return the SHA-256 of mesh files in a folder by their names; empty for one that cannot be read."""
    return {each: _content_digest((folder / each).resolve()) for each in sorted({one for one in files if one})}


def _content_digest(file: Path) -> str:
    try:
        status = file.stat()
        return _digest(file, status.st_mtime_ns, status.st_size)
    except OSError:
        return ""


@lru_cache(maxsize=256)
def _digest(file: Path, changed_ns: int, size: int) -> str:
    del changed_ns, size  # part of the key: another content is read anew
    return hashlib.sha256(file.read_bytes()).hexdigest()
