"""One item that runs of a behavior can cover, with its position in the document and its count."""

from __future__ import annotations

from typing import Literal

import msgspec

ItemKind = Literal["node", "outcome", "transition", "condition", "timeout", "guard", "on_error", "status"]
Key = tuple[str, str, str]


class CoverageItem(msgspec.Struct, frozen=True, kw_only=True, omit_defaults=True):
    """A node that can be entered, or an exit of the node at `path`.

    `name` is the outcome of an `outcome` or `transition`, the text of a `condition` with its number
    in front, or the status of a tree node; `target` is its target. `count` is how often it
    was executed.
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
        """Unique key of the item in its behavior."""
        return (self.kind, self.path, self.name)

    @property
    def place(self) -> str:
        """Position in the document, `file:line:column`."""
        return f"{self.file}:{self.line}:{self.column}"

    @property
    def label(self) -> str:
        """Description of the item, without its path."""
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
