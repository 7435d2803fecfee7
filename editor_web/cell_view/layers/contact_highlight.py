"""Bodies that are in the way: those that the reason of a blocked path names, and those that a jog stands before."""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping

from engine.skills.jogging import JogBlock
from engine.skills.planning import PathPreview


def bodies_in_contact(
    previews: Mapping[str, PathPreview], blocks: Mapping[str, JogBlock], names: Iterable[str]
) -> frozenset[str]:
    """Return the names that occur as whole words in the reason of a blocked path, or are the two of a blocked jog."""
    reasons = [preview.reason for preview in previews.values() if preview.state == "blocked" and preview.reason]
    pairs = {name for block in blocks.values() if block.first for name in (block.first, block.second)}
    if not reasons and not pairs:
        return frozenset()
    return frozenset(name for name in names if name in pairs or any(_names(reason, name) for reason in reasons))


def _names(reason: str, name: str) -> bool:
    return re.search(rf"(?<![\w/]){re.escape(name)}(?![\w/])", reason) is not None
