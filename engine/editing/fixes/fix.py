"""A fix, and the position of the finding that it resolves."""

from __future__ import annotations

import difflib
import re
from collections.abc import Iterable
from dataclasses import dataclass
from typing import cast

from engine.document.nodes.node_kind import MACHINES
from engine.editing.edits.edit import AnyEdit
from engine.editing.edits.edit_session import EditSession
from engine.editing.text.outline import NodeRef, Plain
from engine.library.behavior_library import FindingView

_NAMES = re.compile(r"`([^`]*)`")
_SHORTEST = 4
"""Minimum length of a name for typo detection: in shorter names, one typo gives another word."""
MAX_FIXES = 5
"""Maximum number of fixes offered for a finding."""


@dataclass(frozen=True, kw_only=True)
class Fix:
    """Edits that would resolve a finding; `title` describes them completely.

    A fix is `sure` if it only corrects an evident typo, or removes something without effect: it may be applied
    automatically. For all others a person must choose.
    """

    title: str
    edits: tuple[AnyEdit, ...]
    sure: bool = False


@dataclass(frozen=True, kw_only=True)
class FixContext:
    """A finding with its node.

    `names` are the names in backticks in the message, in order: the subjects of the finding.
    """

    finding: FindingView
    session: EditSession
    ref: NodeRef
    names: tuple[str, ...]

    @property
    def machine(self) -> NodeRef | None:
        """The surrounding machine of the node, if there is one."""
        parent = self.ref.parent
        return parent if parent is not None and parent.kind in MACHINES else None

    @property
    def siblings(self) -> tuple[str, ...]:
        """The names of the other nodes in the surrounding machine."""
        machine = self.machine
        inside = self.session.outline.children(machine) if machine is not None else ()
        return tuple(each.name for each in inside if each.name != self.ref.name)

    @property
    def machine_outcomes(self) -> tuple[str, ...]:
        """The names of the outcomes of the surrounding machine."""
        return self.session.outcomes_inside(self.machine) if self.machine is not None else ()

    def section(self, key: str) -> Plain:
        """Return a mapping of the node; empty if there is none."""
        return mapping(self.ref.data.get(key))


def quoted_names(finding: FindingView) -> tuple[str, ...]:
    """Return the names in the message of a finding."""
    return tuple(_NAMES.findall(finding.message))


def similar_names(name: str, known: Iterable[str], *, most: int = 3) -> list[str]:
    """Return the known names similar to a mistyped one, the closest first."""
    return difflib.get_close_matches(name, sorted(set(known)), n=most, cutoff=0.6)


def is_typo(written: str, meant: str, known: Iterable[str]) -> bool:
    """Return whether a name is evidently a typo: one edit away from the right name, and from no other known name."""
    return _is_near(written, meant) and not any(each != meant and _is_near(written, each) for each in known)


def _is_near(written: str, meant: str) -> bool:
    a, b = (name.lower().replace("-", "_") for name in (written, meant))
    if a == b:
        return True
    if len(min(a, b, key=len)) < _SHORTEST or [c for c in a if c.isdigit()] != [c for c in b if c.isdigit()]:
        return False  # `left_1` is not `left_2`, and `a` not `b`
    begin = next((i for i, (one, other) in enumerate(zip(a, b, strict=False)) if one != other), min(len(a), len(b)))
    rest, other = a[begin:], b[begin:]
    swapped = rest[:2] == other[1::-1] and len(other) > 1 and rest[2:] == other[2:]
    return swapped or other in (rest[1:], f"{other[:1]}{rest[1:]}", f"{other[:1]}{rest}")


def mapping(value: object) -> Plain:
    """Return a mapping unchanged, and an empty one for any other value."""
    return cast("Plain", value) if isinstance(value, dict) else {}


def with_renamed_key(given: Plain, old: str, new: str) -> Plain:
    """Return a mapping with one key renamed, in its position."""
    return {new if key == old else key: value for key, value in given.items()}


def without_key(given: Plain, name: str) -> Plain | None:
    """Return a mapping without a key; None if it becomes empty."""
    return {key: value for key, value in given.items() if key != name} or None


def strings(value: object) -> list[str]:
    """Return the text items of a list."""
    return [each for each in cast("list[object]", value) if isinstance(each, str)] if isinstance(value, list) else []
