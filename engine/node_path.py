"""Node paths: `root/approach/left` is inside `root/approach`."""

from __future__ import annotations


def is_inside(outer: str, path: str) -> bool:
    """Return whether `path` is `outer` or inside it."""
    return path == outer or path.startswith(f"{outer}/")
