"""How a container came to its outcome, from what events tell of its children; no event tells it itself."""

from __future__ import annotations

from collections.abc import Mapping

from engine.event import Cause
from engine.runtime.history.node_state import ActiveNodeState, PendingExit, exit_of
from engine.runtime.nodes.behavior_reference import BehaviorReference
from engine.runtime.nodes.concurrency import Concurrency, finished_with
from engine.runtime.nodes.diagnosis import explain_exit
from engine.runtime.nodes.node import NodeWork


def reason_of(
    work: NodeWork | None, path: str, outcome: str | None, node: ActiveNodeState | None, left: Mapping[str, PendingExit]
) -> Cause | None:
    """Return the reason that a `ContainerOutcome` of the container at `path` has.

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
        ended = {name: exit_of(child) for name in work.children if (child := left.get(f"{path}/{name}"))}
        holding = next(
            (each for each in work.deciding if each.outcome == outcome and each.holds(finished_with(ended))), None
        )
        return work.ended(holding, ended).reason if holding is not None else None
    if isinstance(work, BehaviorReference):
        root = left.get(f"{path}/root")
        return explain_exit(work.target.root, exit_of(root)) if root is not None else None
    return node.diagnosis.reason if node is not None else None
