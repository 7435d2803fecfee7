"""Who has the page open: a name, the document and node that are shown, and the run that is operated, for each page."""

from __future__ import annotations

from collections.abc import Callable
from typing import Annotated

import msgspec
from msgspec.structs import replace


class ShowPresence(msgspec.Struct, frozen=True, kw_only=True, tag="present", tag_field="k"):
    """From the client: what this page shows; the last one counts, and goes with the connection."""

    name: Annotated[str, msgspec.Meta(max_length=40)] = ""
    document: Annotated[str, msgspec.Meta(max_length=300)] = ""
    node: Annotated[str, msgspec.Meta(max_length=4000)] = ""
    edits: bool = False


class Presence(msgspec.Struct, frozen=True, kw_only=True):
    """One open page.

    Attributes:
        page: Its number since the server started.
        name: As the person calls themselves; the role and the number without.
        role: What the page may do.
        document: The behavior that it shows; empty for none.
        node: The node that is selected there; empty for none.
        edits: Whether it is the editor that shows it.
        operates: The run that it operates; empty for none.
        since_s: When it took control of that run, seconds since 1970.
    """

    page: int
    name: str
    role: str
    document: str = ""
    node: str = ""
    edits: bool = False
    operates: str = ""
    since_s: float | None = None


class PresenceChanged(msgspec.Struct, frozen=True, kw_only=True, tag="presence", tag_field="k"):
    """All open pages; `page` is the number of the one that this is sent to."""

    page: int
    present: tuple[Presence, ...]


class PresenceRoster:
    """The open pages by their number; `changed` is called after each change, `now_s` is the wall clock."""

    def __init__(self, *, changed: Callable[[], None], now_s: Callable[[], float]) -> None:
        self._changed = changed
        self._now_s = now_s
        self._present: dict[int, Presence] = {}
        self._last = 0

    @property
    def present(self) -> tuple[Presence, ...]:
        """The pages that have reported what they show, the oldest first."""
        return tuple(self._present.values())

    def new_page(self) -> int:
        """Return the number of a new page; it is present once it says what it shows."""
        self._last += 1
        return self._last

    def show(self, page: int, role: str, shown: ShowPresence) -> None:
        """Note what a page shows."""
        name = shown.name.strip() or f"{role.capitalize()} {page}"
        known = self._present.get(page, Presence(page=page, name=name, role=role))
        now = replace(known, name=name, document=shown.document, node=shown.node, edits=shown.edits)
        if now != self._present.get(page):
            self._present[page] = now
            self._changed()

    def operate(self, page: int, role: str, run: str) -> None:
        """Note which run a page operates; an empty one if none."""
        known = self._present.get(page, Presence(page=page, name=f"{role.capitalize()} {page}", role=role))
        if known.operates != run:
            self._present[page] = replace(known, operates=run, since_s=self._now_s() if run else None)
            self._changed()

    def leave(self, page: int) -> None:
        """Forget a page whose connection has ended."""
        if self._present.pop(page, None) is not None:
            self._changed()
