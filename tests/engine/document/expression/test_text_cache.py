"""The cache holds as much text as it may, newest asked for last."""

from __future__ import annotations

from engine.document.expression.text_cache import TextCache


def test_what_was_asked_for_longest_ago_goes_first() -> None:
    """A long text takes the place of several short ones."""
    made: list[str] = []
    cache: TextCache[int] = TextCache(max_characters=100)

    def make(text: str) -> int:
        made.append(text)
        return len(text)

    assert [cache.get(text, make) for text in ("a", "b", "a", "c" * 50, "a", "b")] == [1, 1, 1, 50, 1, 1]
    assert made == ["a", "b", "c" * 50, "b"]
