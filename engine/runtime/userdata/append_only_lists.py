"""Lists that are extended in place, without a copy for each value."""

from __future__ import annotations

from collections.abc import Hashable
from typing import cast

from engine.event import UserdataAppended, UserdataWritten


class AppendOnlyLists:
    """Tracks lists that were created here and are not shared: only these are extended in place."""

    __slots__ = ("_own",)

    def __init__(self) -> None:
        self._own: dict[Hashable, list[object]] = {}

    def appended(self, place: Hashable, before: list[object], value: object) -> list[object]:
        """Return the list at `place` with one more value: `before` itself if it was created here for that place."""
        own = self._own.get(place)
        if own is not before or own is None:
            own = self._own[place] = list(before)
        own.append(value)
        return own

    def value_after(self, event: UserdataWritten | UserdataAppended, before: object) -> object:
        """Return the value of a key after a write; `before` is its previous value, None for none."""
        if isinstance(event, UserdataWritten):
            return event.value
        so_far = cast("list[object]", [] if before is None else before)
        return self.appended((event.scope, event.key), so_far, event.value)

    def give_away(self) -> None:
        """Stop extending all lists in place, as other code holds them now."""
        self._own.clear()
