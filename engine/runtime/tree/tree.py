"""The tree container: a behavior tree executed by py_trees, ticked only on demand."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property

from engine.document.nodes.node_spec import TREE_OUTCOMES
from engine.runtime.nodes.execution import Execution
from engine.runtime.nodes.node import Node
from engine.runtime.nodes.node_entry import NodeEntry, WithoutEntry
from engine.runtime.tree.runner import TreeRunner
from engine.runtime.tree.tree_history import decode_tree_events
from engine.runtime.tree.tree_node import TreeNode
from engine.runtime.userdata.userdata import Scope
from engine.state import Outcome


@dataclass(frozen=True, kw_only=True)
class Tree(WithoutEntry):
    """Work of a tree node of a plan."""

    root: TreeNode

    @property
    def kind(self) -> str:
        """The key of this container in documents."""
        return "tree"

    @cached_property
    def outcomes(self) -> tuple[str, ...]:
        """The final statuses of its root."""
        return TREE_OUTCOMES

    @property
    def children(self) -> Mapping[str, Node]:
        """The leaves, by their path below the tree, in document order."""
        return self._leaves

    @cached_property
    def _leaves(self) -> Mapping[str, Node]:
        outside = len(self.root.path) - len(self.root.name)
        return {part.path[outside:]: part.leaf.node for part in self.root.walk() if part.leaf is not None}

    @cached_property
    def nominal(self) -> frozenset[str]:
        """Success."""
        return frozenset(("success",))

    def initial_values(self, inputs: Mapping[str, object]) -> Mapping[str, object]:
        """Return nothing: its scope starts empty."""
        return {}

    async def run(self, entry: NodeEntry, path: str, visit: int, scope: Scope, execution: Execution) -> Outcome:
        """Tick the tree to its end; from its checkpoint, if it is resumed."""
        point = entry.point
        runner = TreeRunner(
            self.root,
            path=path,
            scope=execution.scopes.open(path, point.values if point is not None else {}, scope),
            execution=execution,
            history=tuple(decode_tree_events(point.done)) if point is not None else (),
            branches={f"{path}/{name}": written for name, written in point.branches.items()} if point else {},
        )
        return await runner.run()
