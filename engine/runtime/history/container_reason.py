"""Reason of a container's outcome, derived from the events of its children; no event holds it."""

from __future__ import annotations

from collections.abc import Mapping

from engine.errors import Cause
from engine.runtime.history.node_state import ActiveNodeState, PendingExit, exit_of
from engine.runtime.nodes.behavior_reference import BehaviorReference
from engine.runtime.nodes.concurrency import Concurrency, finished_with
from engine.runtime.nodes.diagnosis import explain_exit
from engine.runtime.nodes.node import NodeWork


def reason_of(
    work: NodeWork | None, path: str, outcome: str | None, node: ActiveNodeState | None, left: Mapping[str, PendingExit]
) -> Cause | None:
    """Return the reason of the `ContainerOutcome` of the container at `path`.

    Args:
        work: Its work; None where the plan does not contain it.
        path: The path of the container.
        outcome: Its outcome, if any.
        node: Its state before the exit.
        left: The exits of other nodes, by path.
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
