"""Wildcards over node paths and bus addresses: `*` within one part, `**` over any number of parts."""

from __future__ import annotations

import re
from functools import lru_cache
from typing import Annotated

from msgspec import Meta

PathPattern = Annotated[
    str,
    Meta(min_length=1, description="A node path; `*` matches any text without `/`, `**` any number of parts"),
]


@lru_cache(maxsize=1024)
def compile_pattern(pattern: str) -> re.Pattern[str]:
    """Return a regular expression whose `fullmatch` accepts the paths that match `pattern`.

    `root/*/grasp` has exactly one part between, `root/**/grasp` none or more, `root/**` is `root`
    and everything inside it.
    """
    expression = ""
    parts = re.sub(r"(?<![^/])\*\*(/\*\*)+(?![^/])", "**", pattern).split("/")
    for index, part in enumerate(parts):
        first, last = index == 0, index == len(parts) - 1
        if part == "**":
            expression += ".*" if first and last else "(?:[^/]*/)*" if first else "(?:/[^/]*)*"
            continue
        # A leading `**` already includes the separator.
        expression += "" if first or (index == 1 and parts[0] == "**") else "/"
        expression += "[^/]*".join(re.escape(text) for text in re.split(r"\*+", part))
    return re.compile(expression, re.DOTALL)


def matches(pattern: str, path: str) -> bool:
    """Return whether `path` matches `pattern`."""
    return compile_pattern(pattern).fullmatch(path) is not None
