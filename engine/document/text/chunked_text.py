"""A text as a stream that a C parser reads in chunks."""

from __future__ import annotations


class ChunkedText:
    """A text in chunks: other threads run between chunks, even inside a very long scalar."""

    name = "document"
    """Name in messages of the parser."""

    def __init__(self, text: str) -> None:
        self._data = text.encode()
        self._index = 0

    def read(self, size: int = 65_536, /) -> bytes:
        """Return the next bytes."""
        self._index += size
        return self._data[self._index - size : self._index]
