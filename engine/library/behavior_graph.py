"""The graph of a behavior for the editor and the dashboard: nested nodes with outcomes and transitions."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

import msgspec

from engine.document.behavior import Behavior
from engine.document.nodes.concurrency_condition import deciding
from engine.document.nodes.node_kinds import node_icon
from engine.document.nodes.node_spec import FOREACH_OUTCOMES, TREE_OUTCOMES, NodeSpec
from engine.runtime.plan import Catalogue


class GraphTransition(msgspec.Struct, frozen=True, kw_only=True):
    """A transition of a state machine; the outcome of a timeout is `after 30 s`, that of on_error is `error`."""

    source: str
    outcome: str
    target: str


class GraphNode(msgspec.Struct, frozen=True, kw_only=True, gc=False):
    """One node with its descendants; `path` is the node path of events, `icon` the name of its icon."""

    path: str
    name: str
    kind: str
    icon: str
    title: str
    description: str
    outcomes: tuple[str, ...]
    children: tuple[GraphNode, ...]
    transitions: tuple[GraphTransition, ...]
    initial: str | None
    conditions: tuple[str, ...]
    disabled: bool | str = False
    """The outcome by which a run passes over it, true inside a tree; false if it is not disabled."""


def new_graph(behavior: Behavior, catalogue: Catalogue, *, path: str = "root", name: str = "root") -> GraphNode:
    """Return the graph of a behavior from its root; unknown states have no outcomes."""
    return _GraphBuilder(behavior, catalogue, path).node(name, behavior.root, "root")


def graph_nodes(root: GraphNode) -> Iterator[GraphNode]:
    """Yield a node and all inside it, containers before their children."""
    yield root
    for child in root.children:
        yield from graph_nodes(child)


class _GraphBuilder:
    def __init__(self, behavior: Behavior, catalogue: Catalogue, base: str) -> None:
        self._behavior = behavior
        self._catalogue = catalogue
        self._base = base

    def node(self, name: str, node: NodeSpec, inside: str) -> GraphNode:
        path = self._base + inside.removeprefix("root")
        return GraphNode(
            path=path,
            name=name,
            kind=node.kind,
            icon=node_icon(node.kind, self._catalogue.get(node.state) if node.state is not None else None),
            title=node.state or node.behavior or node.behaviour or "",
            description=node.description,
            outcomes=self._outcomes(node),
            children=self._children(node, inside, path),
            transitions=_transitions(node) if node.sequential is not None else (),
            initial=node.sequential.initial if node.sequential is not None else None,
            conditions=_rules(node),
            disabled=node.disabled or False,
        )

    def _children(self, node: NodeSpec, inside: str, path: str) -> tuple[GraphNode, ...]:
        target = self._behavior.references.get(node.behavior) if node.behavior is not None else None
        if target is not None:
            return (new_graph(target, self._catalogue, path=f"{path}/root", name=target.name),)
        return tuple(self.node(name, child, f"{inside}/{name}") for name, child in node.children.items())

    def _outcomes(self, node: NodeSpec) -> tuple[str, ...]:
        if node.state is not None:
            state = self._catalogue.get(node.state)
            return state.outcomes if state is not None else tuple(node.transitions)
        if node.behavior is not None:
            target = self._behavior.references.get(node.behavior)
            return target.outcomes if target is not None else tuple(node.transitions)
        if node.concurrency is not None:
            otherwise = (node.concurrency.otherwise,) if node.concurrency.otherwise else ()
            return tuple(dict.fromkeys((*(rule.outcome for rule in deciding(node.concurrency.rules)), *otherwise)))
        if node.foreach is not None:
            return FOREACH_OUTCOMES
        if node.sequential is None:
            return TREE_OUTCOMES
        return tuple(dict.fromkeys(arrow.target for arrow in _transitions(node) if arrow.target not in node.children))


def _transitions(node: NodeSpec) -> tuple[GraphTransition, ...]:
    arrows: list[GraphTransition] = []
    for name, child in node.children.items():
        for outcome, target in _exits(child).items():
            arrows.append(GraphTransition(source=name, outcome=outcome, target=target))
    return tuple(arrows)


def _exits(child: NodeSpec) -> Mapping[str, str]:
    exits = dict(child.transitions)
    if child.guard is not None and child.guard.to is not None:
        exits[f"unless {child.guard.when}"] = child.guard.to
    if child.timeout is not None and child.timeout.to is not None:
        exits[f"after {child.timeout.after_s:g} s"] = child.timeout.to
    if child.on_error is not None:
        exits["error"] = child.on_error
    return exits


def _rules(node: NodeSpec) -> tuple[str, ...]:
    if node.concurrency is None:
        return ()
    rules = [f"{rule.consequence}: {rule}" for rule in node.concurrency.rules]
    return (*rules, *([f"{node.concurrency.otherwise}: otherwise"] if node.concurrency.otherwise else []))
