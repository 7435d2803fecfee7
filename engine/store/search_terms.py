"""The search terms of an entry: the words of its name and tags, and its whole tags."""

from __future__ import annotations

import re
from collections.abc import Iterable

_WORD = re.compile(r"[a-z0-9]+")
MAX_PREFIX = 12
AFTER_PREFIX = "\x7f"
"""Appended to a prefix, it gives the first text after all texts with that prefix."""


def terms_of(name: str, tags: Iterable[str]) -> tuple[str, ...]:
    """Return the search terms of an entry, sorted: its words, and each whole tag after a `#`."""
    tags = tuple(tags)
    words = {word for text in (name, *tags) for word in _WORD.findall(text)}
    return tuple(sorted(words | {tag_term(tag) for tag in tags}))


def prefixes_of(words: Iterable[str]) -> tuple[str, ...]:
    """Return all prefixes of words up to `MAX_PREFIX`, and whole tags, sorted: for exact look-ups in an index."""
    prefixes: set[str] = set()
    for word in words:
        is_tag = word.startswith("#")
        prefixes |= {word} if is_tag else {word[:length] for length in range(1, min(len(word), MAX_PREFIX) + 1)}
    return tuple(sorted(prefixes))


def tag_term(tag: str) -> str:
    """Return the search term of a whole tag."""
    return f"#{tag}"


def query_terms(text: str) -> tuple[str, ...]:
    """Return the words of a search text, lower case, longest first."""
    return tuple(sorted(set(_WORD.findall(text.lower())), key=lambda word: (-len(word), word)))
