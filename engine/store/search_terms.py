"""The words by which an entry is found: those of its name and tags, and its tags as a whole."""

from __future__ import annotations

import re
from collections.abc import Iterable

_WORD = re.compile(r"[a-z0-9]+")
MAX_PREFIX = 12
AFTER_PREFIX = "\x7f"
"""Appended to a prefix it makes the first text after all that begin with the prefix."""


def terms_of(name: str, tags: Iterable[str]) -> tuple[str, ...]:
    """Return the words of an entry, sorted; a tag is also kept whole, behind a `#`."""
    tags = tuple(tags)
    found = {word for text in (name, *tags) for word in _WORD.findall(text)}
    return tuple(sorted(found | {tag_term(tag) for tag in tags}))


def prefixes_of(words: Iterable[str]) -> tuple[str, ...]:
    """Return all beginnings of words up to `MAX_PREFIX`, and whole tags, sorted: for exact look-ups in an index."""
    found: set[str] = set()
    for word in words:
        whole = word.startswith("#")
        found |= {word} if whole else {word[:length] for length in range(1, min(len(word), MAX_PREFIX) + 1)}
    return tuple(sorted(found))


def tag_term(tag: str) -> str:
    """Return the word that stands for a whole tag."""
    return f"#{tag}"


def query_terms(text: str) -> tuple[str, ...]:
    """Return the words of a search, lower case, longest first."""
    return tuple(sorted(set(_WORD.findall(text.lower())), key=lambda word: (-len(word), word)))
