"""A behavior that refers to something, with the nodes that do."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True, kw_only=True)
class ReferringBehavior:
    """A behavior that references another one, or names an item of its cell: its id and name, and the nodes that do."""

    id: str
    name: str
    paths: tuple[str, ...]
