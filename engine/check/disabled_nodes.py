"""Checks disabled nodes: the outcome by which each is passed over, and containers of which nothing is left."""

from __future__ import annotations

from collections.abc import Iterator

from engine.check.analyzed_behavior import AnalyzedBehavior
from engine.check.finding import Finding
from engine.document.nodes.concurrency_condition import deciding
from engine.document.nodes.node_spec import FOREACH_OUTCOMES, TREE_OUTCOMES, NodeSpec
from engine.document.signature import StateSignature, read_signature
from engine.document.state_catalogue import find_state
from engine.errors import RegistryError, StateError
from engine.wording.suggestions import did_you_mean


def check_disabled(subject: AnalyzedBehavior) -> Iterator[Finding]:
    """Find outcomes that a disabled node does not have, and containers whose children are all disabled."""
    for path, node in subject.disabled.items():
        outcomes = _outcomes(subject, node) if node.passes_with else None
        if outcomes is not None and node.passes_with not in outcomes:
            message = f"`{path.rpartition('/')[2]}` has no outcome `{node.passes_with}` for `disabled`"
            hint = did_you_mean(node.passes_with, outcomes)
            yield subject.finding("unknown-outcome", message, path, "disabled", hint=hint)
    for placed in subject.due if subject.disabled else ():
        children = subject.children(placed)
        if children and all(child.node.is_disabled for child in children):
            message = f"everything in `{placed.name}` is disabled"
            hint = "disable it instead, unless it is the root" if placed.parent is None else "disable it instead"
            yield subject.finding("all-disabled", message, placed.path, hint=hint)


def disabled_writer(subject: AnalyzedBehavior, key: str) -> str | None:
    """Return the path of a disabled node that would write a key; None if there is none."""
    for path, node in subject.disabled.items():
        for inside, each in ((path, node), *((f"{path}/{below}", each) for below, each in _below(node))):
            signature = _signature(subject, each.state) if each.state is not None else None
            own = signature.outputs.keys() - each.outputs.keys() if signature is not None else ()
            if key in each.outputs.values() or key in own:
                return inside
    return None


def _below(node: NodeSpec) -> Iterator[tuple[str, NodeSpec]]:
    for name, child in node.children.items():
        yield name, child
        yield from ((f"{name}/{below}", each) for below, each in _below(child))


def _outcomes(subject: AnalyzedBehavior, node: NodeSpec) -> tuple[str, ...] | None:
    """Return the outcomes that a disabled node would have; None where they are unknown."""
    if node.state is not None:
        signature = _signature(subject, node.state)
        return signature.outcomes if signature is not None else None
    if node.behavior is not None:
        referred = subject.behavior.references.get(node.behavior)
        return referred.outcomes if referred is not None else None
    if node.concurrency is not None:
        otherwise = (node.concurrency.otherwise,) if node.concurrency.otherwise else ()
        return (*(rule.outcome for rule in deciding(node.concurrency.rules)), *otherwise)
    if node.foreach is not None:
        return FOREACH_OUTCOMES
    if node.tree is not None:
        return TREE_OUTCOMES
    # A machine may be unfinished inside: what leads on from it counts too.
    led_to = [target for child in node.children.values() for target in child.transitions.values()]
    return tuple(dict.fromkeys(each for each in (*led_to, *node.transitions) if each not in node.children))


def _signature(subject: AnalyzedBehavior, state: str) -> StateSignature | None:
    """Return the signature of a state that the run of a behavior does not need; None if there is none."""
    try:
        return read_signature(find_state(subject.catalogue, state, subject.behavior.classes))
    except (RegistryError, StateError):
        return None
