"""Cause of a tree failure: from the failed node down to the leaf and its own cause."""

from __future__ import annotations

from collections.abc import Mapping

from py_trees import composites
from py_trees.behaviour import Behaviour
from py_trees.common import Status

from engine.cause_chain import wrap_cause
from engine.errors import Cause
from engine.runtime.nodes.diagnosis import explain_exit
from engine.runtime.tree.branching import IfThenElse
from engine.runtime.tree.disabled_part import DisabledPart
from engine.runtime.tree.entry_guard import EntryGuard
from engine.runtime.tree.parallel import ThresholdParallel
from engine.runtime.tree.tree_decorator import TreeDecorator
from engine.runtime.tree.tree_leaf import TreeLeaf
from engine.runtime.tree.tree_node import TreeNode


def explain_tree_failure(
    behaviour: Behaviour, parts: Mapping[Behaviour, TreeNode], guards: Mapping[Behaviour, EntryGuard]
) -> Cause:
    """Return the cause of a FAILURE, the outermost node first."""
    part = parts[behaviour]
    if isinstance(behaviour, TreeLeaf):
        if behaviour.left is None:
            return Cause(message=f"{part.name} failed", where=part.path)
        return explain_exit(behaviour.plan.node, behaviour.left)
    guard = guards.get(behaviour)
    if guard is not None and guard.refusal:
        return Cause(message=guard.refusal, where=part.path, kind="Guard")
    if part.foreign is not None:
        feedback = f": {behaviour.feedback_message}" if behaviour.feedback_message else ""
        return Cause(message=f"{part.name} failed{feedback}", where=part.path)
    below = _failed_child(behaviour)
    because = explain_tree_failure(below, parts, guards) if below is not None else None
    count = sum(not child.disabled for child in part.children)
    if isinstance(behaviour, composites.Selector) and count > 1:
        return wrap_cause(f"none of {count} alternatives succeeded; the last one", because, where=part.path)
    if isinstance(behaviour, ThresholdParallel):
        message = f"{behaviour.failed} of {count} failed, and {behaviour.success_count} must succeed; the first"
        return wrap_cause(message, because, where=part.path)
    if isinstance(behaviour, TreeDecorator):
        because = behaviour.explain(part, because)
    return because or Cause(message=f"{part.name} had failed before", where=part.path)


def _failed_child(behaviour: Behaviour) -> Behaviour | None:
    if isinstance(behaviour, TreeDecorator):
        candidates = [behaviour.decorated]
    elif isinstance(behaviour, IfThenElse):
        candidates = [*behaviour.branches, behaviour.condition]
    elif isinstance(behaviour, composites.Selector):
        candidates = behaviour.children[::-1]
    else:
        candidates = behaviour.children
    return next(
        (child for child in candidates if child.status is Status.FAILURE and not isinstance(child, DisabledPart)), None
    )
