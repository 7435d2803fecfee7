"""A node as a run meets it: what the check sees of a disabled one."""

from __future__ import annotations

from engine.document.nodes.node_spec import NodeSpec


def in_run(node: NodeSpec) -> NodeSpec:
    """Return the node as a run meets it: a disabled one is a state that does nothing, and leads on with one outcome."""
    return node.derived(_passed_over) if node.is_disabled else node


def _passed_over(node: NodeSpec) -> NodeSpec:
    outcome = node.passes_with
    transitions = {outcome: node.transitions[outcome]} if outcome in node.transitions else {}
    return NodeSpec(state="", name=node.own_name, transitions=transitions, disabled=node.disabled)
