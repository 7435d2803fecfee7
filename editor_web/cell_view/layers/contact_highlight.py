"""Which bodies a blocked way would let touch each other: those that its reason names."""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping

from engine.skills.planning import PathPreview


def bodies_in_contact(ways: Mapping[str, PathPreview], names: Iterable[str]) -> frozenset[str]:
    """Return those of the names that stand in the reason of a blocked way, as words of their own."""
    reasons = [way.reason for way in ways.values() if way.state == "blocked" and way.reason]
    if not reasons:
        return frozenset()
    return frozenset(name for name in names if any(_names(reason, name) for reason in reasons))


def _names(reason: str, name: str) -> bool:
    return re.search(rf"(?<![\w/]){re.escape(name)}(?![\w/])", reason) is not None
