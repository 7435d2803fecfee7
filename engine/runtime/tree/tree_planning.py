"""Plans a tree of a document: plans leaves, compiles expressions, resolves py_trees behaviours."""

from __future__ import annotations

from collections.abc import Callable, Collection
from dataclasses import dataclass

import msgspec
from py_trees.behaviour import Behaviour as PyTreesBehaviour

from engine.document.behavior import Behavior
from engine.document.duration import seconds
from engine.document.expression.expression import Template, compile_template
from engine.document.nodes import node_spec as nodes
from engine.document.nodes.node_kind import KINDS, PostConditionsSpec
from engine.document.state_catalogue import Catalogue
from engine.errors import DocumentError, ExpressionError, RegistryError
from engine.runtime.nodes.leaf import Leaf
from engine.runtime.nodes.node import Node
from engine.runtime.tree.arguments import takes_name, wrong_arguments
from engine.runtime.tree.behaviour_catalogue import find_behaviour
from engine.runtime.tree.tree import Tree
from engine.runtime.tree.tree_node import Assignment, ForeignPlan, LeafPlan, TreeNode
from engine.wording.suggestions import did_you_mean

WHERE_NOTHING_WAKES_S = 0.1
"""Default tick period of a node that is RUNNING while nothing below it can wake the tree."""
PlanNode = Callable[[str, str, nodes.NodeSpec], Node]


def new_tree(
    inside: str, node: nodes.NodeSpec, *, base: str, behavior: Behavior, catalogue: Catalogue, plan: PlanNode
) -> Tree:
    """Plan the tree of a node.

    Args:
        inside: The node's path in its own document.
        node: The node, whose kind is `tree`.
        base: The path of the document's root in the run.
        behavior: The document.
        catalogue: The states and behaviours that it may name.
        plan: Plans a state or container, from its name, its path in the document, and its specification.

    Raises:
        DocumentError: a node of the tree is invalid; `where` is the position.
    """
    return Tree(root=_Planner(base, behavior, catalogue, plan).children(inside, node)[0])


@dataclass(frozen=True)
class _Planner:
    base: str
    behavior: Behavior
    catalogue: Catalogue
    plan: PlanNode

    def children(self, inside: str, node: nodes.NodeSpec) -> tuple[TreeNode, ...]:
        return tuple(self._part(name, f"{inside}/{name}", child) for name, child in node.children.items())

    def _part(self, name: str, inside: str, node: nodes.NodeSpec) -> TreeNode:
        path, position = self.base + inside.removeprefix("root"), str(self.behavior.position(inside))
        if node.is_disabled:
            return TreeNode(path=path, name=name, position=position, source=node)
        is_leaf = node.kind in KINDS
        return TreeNode(
            path=path,
            name=name,
            position=position,
            source=node,
            children=() if is_leaf else self.children(inside, node),
            leaf=self._leaf(name, inside, node) if is_leaf else None,
            foreign=self._foreign(inside, node) if node.behaviour is not None else None,
            post=self._post(inside, node.post) if node.post is not None else {},
            when=self._template(inside, "guard", node.guard.when) if node.guard is not None and not is_leaf else None,
        )

    def _leaf(self, name: str, inside: str, node: nodes.NodeSpec) -> LeafPlan:
        planned = self.plan(name, inside, node)
        for index, outcome in enumerate(node.success):
            if outcome not in planned.work.outcomes:
                where = self.behavior.position(inside, "success", index)
                hint = did_you_mean(outcome, planned.work.outcomes)
                raise DocumentError(f"`{name}` has no outcome `{outcome}`", where=where, hint=hint)
        success = frozenset(node.success) or planned.work.nominal
        return LeafPlan(
            node=planned,
            success=success,
            check=not _commands(planned),
            reads=_reads(planned),
            every_s=_every_s(node, planned),
        )

    def _foreign(self, inside: str, node: nodes.NodeSpec) -> ForeignPlan:
        kind = self._class(inside, node.behaviour or "")
        problem = wrong_arguments(kind, node.parameters)
        if problem is not None:
            raise DocumentError(problem[0], where=self.behavior.position(inside, "with"), hint=problem[1])
        return ForeignPlan(
            kind=kind,
            takes_name=takes_name(kind),
            arguments=self._template(inside, "with", node.parameters),
            inputs=node.inputs,
            outputs=node.outputs,
            every_s=seconds(node.every) if node.every is not None else WHERE_NOTHING_WAKES_S,
        )

    def _post(self, inside: str, post: PostConditionsSpec) -> dict[str, tuple[Assignment, ...]]:
        given: dict[str, dict[str, object]] = msgspec.structs.asdict(post)
        return {
            when: tuple((key, self._template(inside, "post", value)) for key, value in assigned.items())
            for when, assigned in given.items()
        }

    def _class(self, inside: str, name: str) -> type[PyTreesBehaviour]:
        try:
            return find_behaviour(self.catalogue, name, self.behavior.classes)
        except RegistryError as error:
            where = self.behavior.position(inside, "behaviour")
            raise DocumentError(error.message, where=where, hint=error.hint) from error

    def _template(self, inside: str, key: str, value: object) -> Template:
        try:
            return compile_template(value)
        except ExpressionError as error:
            where = self.behavior.position(inside, key)
            raise DocumentError(error.message, where=where, hint=error.hint) from error


def _commands(node: Node) -> bool:
    """Return whether a leaf may command a device, as declared by its states."""
    work = node.work
    if isinstance(work, Leaf):
        return work.commands_hardware
    if isinstance(work, Tree) and any(part.foreign is not None for part in work.root.walk()):
        return True
    # A priority container holds all other branches.
    return work.kind == "priority" or _any_commands(work.children.values())


def _reads(node: Node) -> frozenset[str] | None:
    """Return the userdata keys that a state depends on; None for a container, which is not analyzed."""
    work = node.work
    if not isinstance(work, Leaf):
        return None
    guard = node.guard.when.names if node.guard is not None else ()
    return work.reads.union(guard)


def _every_s(source: nodes.NodeSpec, planned: Node) -> float | None:
    if source.every is not None:
        return seconds(source.every)
    observes = isinstance(planned.work, Leaf) and planned.work.state.observes
    return WHERE_NOTHING_WAKES_S if observes else None


def _any_commands(inside: Collection[Node]) -> bool:
    return any(_commands(child) for child in inside)
