"""A text as a stream that a parser in C reads in portions."""

from __future__ import annotations


class ChunkedText:
    """A text in portions: between two of them other threads have a turn, also inside of a very long scalar."""

    name = "document"
    """What the parser calls it."""

    def __init__(self, text: str) -> None:
        self._data = text.encode()
        self._index = 0

    def read(self, size: int = 65_536, /) -> bytes:
        """Return the next bytes."""
        self._index += size
        return self._data[self._index - size : self._index]
