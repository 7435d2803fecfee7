"""Paths of nodes: `root/approach/left` lies in `root/approach`."""

from __future__ import annotations


def is_inside(outer: str, path: str) -> bool:
    """Tell whether `path` is `outer` or lies in it."""
    return path == outer or path.startswith(f"{outer}/")
