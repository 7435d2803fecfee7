"""The kinds of nodes of a behavior document, and the types of the names and words in them."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Annotated, Literal, get_args

from msgspec import Meta

from engine.document.decoding import StrictModel

PlainKind = Literal["state", "machine", "concurrency", "priority", "tree", "foreach", "behavior"]
TreeKind = Literal[
    "sequence",
    "selector",
    "parallel",
    "inverter",
    "one_shot",
    "repeat",
    "cooldown",
    "remap",
    "condition",
    "if_then_else",
    "while_do_else",
    "behaviour",
]
"""Kinds allowed only inside a tree; `retry`, `timeout` and `guard` with a `child` are three more."""
Wrapper = Literal["retry", "timeout", "guard"]
NodeKind = PlainKind | TreeKind | Wrapper
KINDS: tuple[PlainKind, ...] = get_args(PlainKind)
TREE_KINDS: tuple[TreeKind, ...] = get_args(TreeKind)
WRAPPERS: tuple[Wrapper, ...] = get_args(Wrapper)
"""Keys of every node that are decorators inside a tree, if they have a `child`."""

SLOTS: Mapping[str, tuple[str, ...]] = {
    "if_then_else": ("if", "then", "else"),
    "while_do_else": ("while", "do", "else"),
}
"""The keys of the children of parts whose children have roles, in tick order."""

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
Count = Annotated[int, Meta(ge=1, description="For `at_least`: number of children")]
Times = Annotated[int, Meta(ge=1, le=1_000_000, description="Number of times, 1 or more")]


Assignments = Annotated[dict[Key, object], Meta(description="`{userdata key: value}`, in this order")]


class PostConditionsSpec(StrictModel, frozen=True, kw_only=True):
    """Userdata that is assigned when a part of a tree has ended or was halted; values may contain `${…}`.

    `always` applies after success and failure, after the others. A skipped part assigns nothing.
    """

    on_success: Assignments = {}
    on_failure: Assignments = {}
    on_halted: Assignments = {}
    always: Assignments = {}


def numbered(wanted: Iterable[str]) -> list[str]:
    """Return unique names for the children of a part of a tree; duplicates get a number."""
    names: dict[str, None] = {}
    seen: dict[str, int] = {}
    for own in wanted:
        name = own
        while name in names:
            seen[own] = seen.get(own, 1) + 1
            name = f"{own}_{seen[own]}"
        names[name] = None
    return list(names)
