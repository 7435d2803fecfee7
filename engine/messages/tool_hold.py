"""What the states of all kinds of tools share: whether the tool holds something, and what."""

from __future__ import annotations

from typing import Protocol, runtime_checkable


@runtime_checkable
class ToolHold(Protocol):
    """A measured state of a tool; each kind has a message of its own."""

    @property
    def held(self) -> bool:
        """True while the tool holds something."""
        ...

    @property
    def part(self) -> str:
        """Name of the held part, `?` when unknown, empty for none."""
        ...
