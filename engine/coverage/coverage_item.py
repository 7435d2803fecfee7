"""One thing that runs of a behavior can do, with where it is written and how often it was done."""

from __future__ import annotations

from typing import Literal

import msgspec

ItemKind = Literal["node", "outcome", "transition", "condition", "timeout", "guard", "on_error", "status"]
ITEM_KINDS: tuple[ItemKind, ...] = (
    "node",
    "outcome",
    "transition",
    "condition",
    "timeout",
    "guard",
    "on_error",
    "status",
)
Key = tuple[str, str, str]


class CoverageItem(msgspec.Struct, frozen=True, kw_only=True, omit_defaults=True):
    """A node that can be entered, or a way in which the node at `path` can end or be left.

    `name` is the outcome of an `outcome` or `transition`, the text of a `condition` with its number
    in front, or the status of a part of a tree; `target` is where it leads. `count` is how often it
    was seen.
    """

    kind: ItemKind
    path: str
    name: str = ""
    target: str = ""
    file: str
    line: int
    column: int
    count: int = 0

    @property
    def key(self) -> Key:
        """What tells it apart in its behavior."""
        return (self.kind, self.path, self.name)

    @property
    def place(self) -> str:
        """Where it is written, `file:line:column`."""
        return f"{self.file}:{self.line}:{self.column}"

    @property
    def label(self) -> str:
        """What it is, in words, beside its path."""
        match self.kind:
            case "node":
                return "never entered" if not self.count else "entered"
            case "transition":
                return f"{self.name} → {self.target}"
            case "timeout" | "guard" | "on_error":
                return f"{self.kind} → {self.target}"
            case "condition":
                return f"condition {self.name}"
            case "outcome" | "status":
                return f"{self.kind} {self.name}"
