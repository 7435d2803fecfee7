"""Bodies that would collide on a blocked path: those that its reason names."""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping

from engine.skills.planning import PathPreview


def bodies_in_contact(previews: Mapping[str, PathPreview], names: Iterable[str]) -> frozenset[str]:
    """Return the names that occur as whole words in the reason of a blocked path."""
    reasons = [preview.reason for preview in previews.values() if preview.state == "blocked" and preview.reason]
    if not reasons:
        return frozenset()
    return frozenset(name for name in names if any(_names(reason, name) for reason in reasons))


def _names(reason: str, name: str) -> bool:
    return re.search(rf"(?<![\w/]){re.escape(name)}(?![\w/])", reason) is not None
