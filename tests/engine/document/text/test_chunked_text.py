"""A text comes out of its portions as it went in."""

from __future__ import annotations

from engine.document.text.chunked_text import ChunkedText


def test_portions_together_are_the_text() -> None:
    """A character of several bytes may be cut; the parser puts it together."""
    text = "a\u00e9\U0001f600b" * 10
    portions = ChunkedText(text)
    assert b"".join(iter(lambda: portions.read(7), b"")).decode() == text
