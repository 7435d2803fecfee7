"""A cache by text whose memory is bounded by the texts in it, however long each of them is."""

from __future__ import annotations

from collections import OrderedDict
from collections.abc import Callable
from threading import Lock
from typing import Generic, TypeVar

T = TypeVar("T")
_ENTRY = 20
"""What an entry costs beside its text, in characters."""


class TextCache(Generic[T]):
    """Keeps what was made of texts; those asked for longest ago go first.

    Args:
        max_characters: Length of all texts together.
    """

    def __init__(self, *, max_characters: int) -> None:
        self._most = max_characters
        self._held = 0
        self._known: OrderedDict[str, T] = OrderedDict()
        self._lock = Lock()

    def get(self, text: str, make: Callable[[str], T]) -> T:
        """Return what is known of a text, made by `make` the first time; what that raises is not kept."""
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
