"""The words for kinds of nodes that are no decorators, and the types of the names and words in documents."""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from pathlib import PurePosixPath
from typing import Annotated, Literal

from msgspec import Meta

from engine.document.text.decoding import StrictModel

KINDS = ("state", "machine", "concurrency", "priority", "tree", "foreach", "behavior")
"""Kinds that are allowed everywhere; all others are parts of trees."""
MACHINES = ("machine", "priority")
NAMED = ("machine", "priority", "concurrency")
"""Containers whose children have keys."""
GROUPS = ("sequence", "selector", "parallel")
"""Parts of trees with any number of children."""
SLOTS: Mapping[str, tuple[str, ...]] = {
    "if_then_else": ("if", "then", "else"),
    "while_do_else": ("while", "do", "else"),
}
"""The keys of the children of parts whose children have roles, in tick order."""
WRAPPERS = ("retry", "timeout", "guard")
"""Keys of every node that are decorators inside a tree, if they have a `child`."""
COMMON_KEYS = frozenset(
    ("every", "name", "parameters", "inputs", "outputs", "transitions", "post", "on_error", "autonomy", "resume",
     "success", "description", "disabled", *WRAPPERS)
)  # fmt: skip
"""The attributes of a node that are not its kind."""

Key = Annotated[str, Meta(pattern="^[A-Za-z_][A-Za-z0-9_]{0,63}$", description="Letters, digits and `_`")]
NodeName = Annotated[
    str, Meta(pattern="^[A-Za-z0-9_][A-Za-z0-9_-]{0,63}$", description="Letters, digits, `_` and `-`, no `/`")
]
OutcomeName = Annotated[
    str, Meta(pattern="^[A-Za-z0-9_][A-Za-z0-9_-]{0,63}$", description="Letters, digits, `_` and `-`")
]
Reference = Annotated[str, Meta(min_length=1, description="A behavior file, relative to this document")]
Expression = Annotated[str, Meta(min_length=1, description="An expression, `${…}`")]
AutonomyLevel = Literal["off", "low", "high", "full"]
Status = Literal["success", "failure", "running"]
TreeStatus = Literal["success", "failure", "running", "skipped"]
Count = Annotated[int, Meta(ge=1, description="For `at_least`: number of children")]
Times = Annotated[int, Meta(ge=1, le=1_000_000, description="Number of times, 1 or more")]

Assignments = Annotated[dict[Key, object], Meta(description="`{userdata key: value}`, in this order")]


@dataclass(frozen=True)
class FormField:
    """How a field of a node is shown in forms, and its value in a new node; a field without a label is not shown."""

    label: str = ""
    hint: str = ""
    new: object = None


class PostConditionsSpec(StrictModel, frozen=True, kw_only=True):
    """Userdata that is assigned when a part of a tree has ended or was halted; values may contain `${…}`.

    `always` applies after success and failure, after the others. A skipped part assigns nothing.
    """

    on_success: Assignments = {}
    on_failure: Assignments = {}
    on_halted: Assignments = {}
    always: Assignments = {}


def numbered(labels: Iterable[str]) -> list[str]:
    """Return unique names for the children of a part of a tree; duplicates get a number."""
    names: dict[str, None] = {}
    seen: dict[str, int] = {}
    for own in labels:
        name = own
        while name in names:
            seen[own] = seen.get(own, 1) + 1
            name = f"{own}_{seen[own]}"
        names[name] = None
    return list(names)


def derived_name(runs: str, reference: str, kind: str) -> str:
    """Return the name of a part of a tree without one: from the state, py_trees behaviour or file, else its kind."""
    last = re.split(r"[.:]", runs)[-1] or (PurePosixPath(reference).stem if reference else "")
    return re.sub(r"[^A-Za-z0-9_-]", "_", last)[:64] or kind or "node"
