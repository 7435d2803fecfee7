"""Reads untrusted XML: no document types, no entities, bounded size, depth and number of elements."""

from __future__ import annotations

import xml.etree.ElementTree as ET
from pathlib import Path

from engine.errors import CellError

MAX_BYTES = 8 * 2**20
MAX_ELEMENTS = 50_000
MAX_DEPTH = 64
_DOCTYPE = b"<!DOCTYPE"


class _Bounded(ET.TreeBuilder):
    """Builds a tree within the limits; an exception here ends the parsing."""

    def __init__(self) -> None:
        super().__init__()
        self._depth = self._elements = 0

    def doctype(self, name: str, pubid: str | None, system: str | None) -> None:
        """Reject a document type before it defines any entity."""
        raise ValueError("it has a document type (<!DOCTYPE …>), which may define unbounded entities")

    def start(self, tag: str, attrs: dict[str, str], /) -> ET.Element:
        """Begin an element."""
        self._depth += 1
        self._elements += 1
        if self._depth > MAX_DEPTH:
            raise ValueError(f"its elements are nested more than {MAX_DEPTH} levels deep")
        if self._elements > MAX_ELEMENTS:
            raise ValueError(f"it has more than {MAX_ELEMENTS} elements")
        return super().start(tag, attrs)

    def end(self, tag: str, /) -> ET.Element:
        """End an element."""
        self._depth -= 1
        return super().end(tag)


def read_text(path: Path, *, what: str) -> str:
    """Return the text of a file of at most `MAX_BYTES`.

    Raises:
        CellError: it cannot be read, is too large, or is not UTF-8.
    """
    try:
        with path.open("rb") as stream:
            data = stream.read(MAX_BYTES + 1)
        if len(data) > MAX_BYTES:
            raise ValueError(f"it has more than {MAX_BYTES} bytes")
        return data.decode()
    except (OSError, ValueError) as error:
        raise _unreadable(what, error, path) from error


def parse_xml(text: str, *, what: str, where: Path) -> ET.Element:
    """Return the root element of a document.

    Raises:
        CellError: it is not XML, or exceeds the limits.
    """
    try:
        return ET.fromstring(text, ET.XMLParser(target=_Bounded()))  # noqa: S314 - no entities, no depth: see _Bounded
    except (ET.ParseError, ValueError) as error:
        raise _unreadable(what, error, where) from error


def require_no_doctype(data: bytes) -> None:
    """Reject XML for third-party readers if it could define entities.

    Raises:
        ValueError: it has a document type, or an encoding that could hide one.
    """
    if b"\0" in data or data[:2] in (b"\xff\xfe", b"\xfe\xff") or _DOCTYPE in data:
        raise ValueError("it has a document type (<!DOCTYPE …>), or is not in UTF-8")
    data.decode()


def _unreadable(what: str, error: Exception, where: Path) -> CellError:
    reason = error.strerror or str(error) if isinstance(error, OSError) else str(error)
    return CellError(f"the {what} cannot be read: {reason}", where=str(where), hint="correct the model folder")
