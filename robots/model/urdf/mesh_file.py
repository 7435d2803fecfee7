"""Checks the mesh files of a model before any library reads them: type, size, number of triangles."""

from __future__ import annotations

import struct
from pathlib import Path

from engine.errors import CellError
from robots.model.urdf.untrusted_xml import require_no_doctype

MAX_BYTES = 64 * 2**20
"""Maximum bytes of one mesh file."""
MAX_TRIANGLES = 1_000_000
"""Maximum triangles of one mesh file."""
_STL_HEAD, _STL_TRIANGLE = 84, 50
_SUFFIXES = (".stl", ".dae", ".obj")


def verify_mesh_file(path: Path) -> None:
    """Check one file.

    Raises:
        CellError: it cannot be read, is not an STL, Collada or OBJ file, or exceeds the limits.
    """
    try:
        if path.suffix.lower() not in _SUFFIXES:
            raise ValueError(f"its file type is not one of {', '.join(_SUFFIXES)}")
        size = path.stat().st_size
        if size > MAX_BYTES:
            raise ValueError(f"it has {size} bytes, more than {MAX_BYTES}")
        _verify(path.suffix.lower(), path.read_bytes())
    except (OSError, ValueError) as error:
        reason = error.strerror or str(error) if isinstance(error, OSError) else str(error)
        raise CellError(
            f"the mesh cannot be used: {reason}", where=str(path), hint="correct the model folder, or simplify the mesh"
        ) from error


def require_triangles(count: int, path: Path) -> None:
    """Check the number of triangles in a file.

    Raises:
        CellError: there are too many.
    """
    if count > MAX_TRIANGLES:
        raise CellError(
            f"the mesh cannot be used: it has {count} triangles, more than {MAX_TRIANGLES}",
            where=str(path),
            hint="simplify the mesh",
        )


def _verify(suffix: str, data: bytes) -> None:
    match suffix:
        case ".dae":
            require_no_doctype(data)
        case ".obj":
            _verify_obj(data)
        case _:
            _verify_stl(data)


def _verify_stl(data: bytes) -> None:
    if data[:5].lower() == b"solid" and b"facet" in data[:1000]:
        triangles = data.count(b"endfacet")
    elif len(data) < _STL_HEAD:
        raise ValueError("it is not an STL file")
    else:
        triangles = struct.unpack_from("<I", data, _STL_HEAD - 4)[0]
        if len(data) != _STL_HEAD + _STL_TRIANGLE * triangles:
            raise ValueError(f"its header states {triangles} triangles, which does not fit its {len(data)} bytes")
    if triangles > MAX_TRIANGLES:
        raise ValueError(f"it has {triangles} triangles, more than {MAX_TRIANGLES}")


def _verify_obj(data: bytes) -> None:
    """Check an OBJ file; a polygon may become many triangles, so its corners are counted."""
    corners = 0
    for line in data.splitlines():
        words = line.split()
        if words[:1] == [b"f"]:
            corners += len(words) - 1
        elif words[:1] == [b"mtllib"] and (b"/" in line or b"\\" in line or b".." in line):
            raise ValueError(f"it refers to materials outside its folder: {line.decode(errors='replace')[:80]}")
        if corners > 3 * MAX_TRIANGLES:
            raise ValueError(f"it has more than {MAX_TRIANGLES} triangles")
