"""A behavior tree as planned: its parts with everything compiled, shared by any number of runs."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from functools import cached_property

from py_trees.behaviour import Behaviour

from engine.document import node_spec as nodes
from engine.document.expression import Template
from engine.runtime.nodes.node import Node


@dataclass(frozen=True, kw_only=True)
class LeafPlan:
    """A state or container as a leaf.

    `success` names the outcomes that mean SUCCESS. A `check` commands no device: it may begin
    while others are still being stopped, and what it says at once counts in the same tick.
    `reads` are the userdata keys that it depends on, None where that may be any; `every_s` is how
    often it is asked again while it stands in front of what is at work, None for never by time.
    """

    node: Node
    success: frozenset[str]
    check: bool
    reads: frozenset[str] | None
    every_s: float | None


@dataclass(frozen=True, kw_only=True)
class ForeignPlan:
    """A py_trees behaviour as a leaf: its class, its arguments, and which blackboard keys are userdata.

    `every_s` is how often it is ticked while it is RUNNING, as nothing else would wake it.
    """

    kind: type[Behaviour]
    takes_name: bool
    arguments: Template
    inputs: Mapping[str, str]
    outputs: Mapping[str, str]
    every_s: float


Assignment = tuple[str, Template]
"""A userdata key and the value that it is given."""


@dataclass(frozen=True, kw_only=True)
class TreeNode:
    """One node of a tree: a composite or decorator as documented in `source`, or a leaf."""

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
    """What is assigned, by `on_success` and so on; empty where nothing ever is."""

    @cached_property
    def skips(self) -> bool:
        """Whether it may be skipped, by a guard of its own or because of what is inside."""
        guard = self.source.guard
        return (guard is not None and guard.to == "skipped") or any(child.skips for child in self.children)

    @cached_property
    def holds_foreign(self) -> bool:
        """Whether it is a py_trees behaviour, or one is inside."""
        return self.foreign is not None or any(child.holds_foreign for child in self.children)

    def walk(self) -> Iterator[TreeNode]:
        """Go through this part and everything below it, in document order."""
        due: list[TreeNode] = [self]
        while due:
            part = due.pop()
            yield part
            due += reversed(part.children)
