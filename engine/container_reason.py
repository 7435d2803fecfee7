"""How a container came to its outcome, from what events tell of its children; no event tells it itself."""

from __future__ import annotations

from collections.abc import Mapping

from engine.concurrency import Concurrency, has_ended
from engine.diagnosis import explain
from engine.event import Cause
from engine.node import Work
from engine.node_standing import LeftNode, OpenNode, as_left
from engine.reference import Reference


def reason_of(
    work: Work | None, path: str, outcome: str | None, node: OpenNode | None, left: Mapping[str, LeftNode]
) -> Cause | None:
    """Return the reason that `engine.node_exit.ContainerOutcome` has for an outcome of the container at `path`.

    Args:
        work: What it does, where the plan knows.
        path: Where it is.
        outcome: Its outcome, if any.
        node: How it stood before that.
        left: The nodes that were left, by path.
    """
    if work is None or outcome is None:
        return None
    if isinstance(work, Concurrency):
        ended = {name: as_left(child) for name in work.children if (child := left.get(f"{path}/{name}"))}
        holding = next(
            (each for each in work.deciding if each.outcome == outcome and each.holds(has_ended(ended))), None
        )
        return work.ended(holding, ended).reason if holding is not None else None
    if isinstance(work, Reference):
        root = left.get(f"{path}/root")
        return explain(work.target.root, as_left(root)) if root is not None else None
    return node.diagnosis.reason if node is not None else None
