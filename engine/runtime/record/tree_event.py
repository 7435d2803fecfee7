"""What happened to a node of a behavior tree, as a run keeps it to resume the tree."""

from __future__ import annotations

from typing import NamedTuple


class TreeEvent(NamedTuple):
    """One event of a tree node: its path, what happened, and the time of the run.

    `what` is a status, `entered`, `failed`, `outcome NAME`, `target NAME`, `attempt NUMBER` or `assigned WHEN`.
    """

    path: str
    what: str
    at_s: float
