"""A cache keyed by text, bounded by the total length of its texts."""

from __future__ import annotations

from collections import OrderedDict
from collections.abc import Callable
from threading import Lock
from typing import Generic, TypeVar

T = TypeVar("T")
_ENTRY = 20
"""Overhead of an entry, in characters."""


class TextCache(Generic[T]):
    """Caches values computed from texts; evicts the least recently used ones.

    Args:
        max_characters: Maximum total length of all texts.
    """

    def __init__(self, *, max_characters: int) -> None:
        self._most = max_characters
        self._held = 0
        self._known: OrderedDict[str, T] = OrderedDict()
        self._lock = Lock()

    def get(self, text: str, make: Callable[[str], T]) -> T:
        """Return the cached value of a text, computed by `make` on first use; exceptions are not cached."""
        with self._lock:
            if text in self._known:
                self._known.move_to_end(text)
                return self._known[text]
        made = make(text)
        with self._lock:
            self._add(text, made)
        return made

    def _add(self, text: str, made: T) -> None:
        if text not in self._known:
            self._held += len(text) + _ENTRY
        self._known[text] = made
        while self._held > self._most:
            oldest, _ = self._known.popitem(last=False)
            self._held -= len(oldest) + _ENTRY
