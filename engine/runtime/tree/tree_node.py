"""Planned behavior tree: its compiled nodes, shared by any number of runs."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from functools import cached_property

from py_trees.behaviour import Behaviour

from engine.document.expression.expression import Template
from engine.document.nodes import node_spec as nodes
from engine.runtime.nodes.node import Node


@dataclass(frozen=True, kw_only=True)
class LeafPlan:
    """A state or container as a leaf.

    `success` names the outcomes that mean SUCCESS. A `check` commands no device: it may begin while other leaves are
    still being stopped, and a status that it has at once applies in the same tick. `reads` are the userdata keys that
    it depends on, None for any key; `every_s` is the period of its observation in front of active nodes, None for none.
    """

    node: Node
    success: frozenset[str]
    check: bool
    reads: frozenset[str] | None
    every_s: float | None


@dataclass(frozen=True, kw_only=True)
class ForeignPlan:
    """A py_trees behaviour as a leaf: its class, its arguments, and which blackboard keys are userdata.

    `every_s` is its tick period while it is RUNNING, as nothing else wakes the tree.
    """

    kind: type[Behaviour]
    takes_name: bool
    arguments: Template
    inputs: Mapping[str, str]
    outputs: Mapping[str, str]
    every_s: float


Assignment = tuple[str, Template]
"""A userdata key and its assigned value."""


@dataclass(frozen=True, kw_only=True)
class TreeNode:
    """One node of a tree: a composite or decorator as specified in `source`, or a leaf."""

    path: str
    name: str
    position: str
    source: nodes.NodeSpec = field(repr=False)
    children: tuple[TreeNode, ...] = ()
    leaf: LeafPlan | None = None
    foreign: ForeignPlan | None = None
    when: Template | None = None
    """The condition of a guard."""
    post: Mapping[str, tuple[Assignment, ...]] = field(default_factory=dict[str, tuple[Assignment, ...]])
    """The assignments by `on_success` and so on; empty for none."""

    @property
    def disabled(self) -> bool:
        """Whether its parent passes over it; then nothing of it is planned."""
        return self.source.is_disabled

    @cached_property
    def skips(self) -> bool:
        """Whether it may be skipped: it is disabled or guarded, or a node inside may be skipped."""
        guard = self.source.guard
        return (
            self.disabled
            or (guard is not None and guard.to == "skipped")
            or any(child.skips for child in self.children)
        )

    @cached_property
    def holds_foreign(self) -> bool:
        """Whether it is a py_trees behaviour, or one is inside."""
        return self.foreign is not None or any(child.holds_foreign for child in self.children)

    def walk(self) -> Iterator[TreeNode]:
        """Yield this node and everything below it, in document order."""
        due: list[TreeNode] = [self]
        while due:
            part = due.pop()
            yield part
            due += reversed(part.children)
