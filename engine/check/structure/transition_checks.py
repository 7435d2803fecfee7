"""Checks that every outcome is connected and every transition target exists."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping, Sequence

from engine.check.analyzed_behavior import AnalyzedBehavior, NodeAt
from engine.check.finding import Finding
from engine.document.nodes.node_spec import NodeSpec
from engine.document.state_catalogue import StateCatalogue
from engine.errors import FlexcellError, ModuleNotAllowed
from engine.wording.suggestions import did_you_mean


def check_transitions(subject: AnalyzedBehavior) -> Iterator[Finding]:
    """Find unknown states, outcomes and targets, and outcomes without a target."""
    for placed in subject.due:
        node = placed.node
        if node.state is not None and node.state in subject.unknown:
            yield _unknown(subject, placed, node.state, subject.unknown[node.state])
        elif node.state is not None:
            yield from _outdated(subject, placed)
        if node.retry is not None or node.autonomy or node.success or node.foreach is not None:
            yield from _check_named_outcomes(subject, placed)
        if node.machine is not None or node.priority is not None:
            yield from _check_machine(subject, placed)
    yield from _check_root(subject)


def _unknown(subject: AnalyzedBehavior, placed: NodeAt, name: str, error: FlexcellError) -> Finding:
    if isinstance(error, ModuleNotAllowed):
        return subject.finding("module-not-allowed", error.message, placed.path, "state", hint=error.hint or "")
    message = f"there is no state `{name}`"
    hint = error.hint or "" if error.message == message else str(error)
    return subject.finding("unknown-state", message, placed.path, "state", hint=hint)


def _outdated(subject: AnalyzedBehavior, placed: NodeAt) -> Iterator[Finding]:
    signature = subject.signature(placed.node)
    catalogue = subject.catalogue
    if signature is None or not isinstance(catalogue, StateCatalogue):
        return
    error = catalogue.outdated_class(signature.state)
    if error is not None:
        yield subject.finding("outdated-state", error.message, placed.path, "state", hint=error.hint or "")


def _check_named_outcomes(subject: AnalyzedBehavior, placed: NodeAt) -> Iterator[Finding]:
    """Find outcomes in `retry`, `autonomy`, `success` and `next` that the node does not have."""
    node = placed.node
    named: list[tuple[str, Sequence[str | int], str, bool]] = []
    if node.retry is not None and node.retry.child is None:
        outcomes = _each(node.retry.outcomes)
        named += [(outcome, ("retry", "outcomes", i), "for `retry`", False) for i, outcome in outcomes]
    named += [(outcome, ("autonomy", outcome), "for `autonomy`", True) for outcome in node.autonomy]
    named += [(outcome, ("success", i), "for `success`", False) for i, outcome in _each(node.success)]
    if named:
        yield from _check_known(subject, placed, placed, named)
    if node.foreach is not None and node.foreach.next:
        child = subject.children(placed)[0]
        following = [(o, ("foreach", "next", i), "for `next`", False) for i, o in _each(node.foreach.next)]
        yield from _check_known(subject, placed, child, following)


def _each(outcomes: Sequence[str]) -> list[tuple[int, str]]:
    return list(enumerate(outcomes))


def _check_known(
    subject: AnalyzedBehavior, placed: NodeAt, of: NodeAt, named: Sequence[tuple[str, Sequence[str | int], str, bool]]
) -> Iterator[Finding]:
    outcomes = subject.outcomes.get(of.path)
    for outcome, keys, use, at_key in named if outcomes is not None and not of.node.is_disabled else ():
        if outcome not in (outcomes or ()):
            message = f"`{of.name}` has no outcome `{outcome}` {use}"
            hint = did_you_mean(outcome, outcomes or ())
            yield subject.finding("unknown-outcome", message, placed.path, *keys, hint=hint, at_key=at_key)


def _check_machine(subject: AnalyzedBehavior, placed: NodeAt) -> Iterator[Finding]:
    siblings = placed.node.children
    outcomes = _machine_outcomes(subject, placed)
    for child in subject.children(placed):
        if outcomes is not None and child.name in outcomes:
            message = f"`{child.name}` is both a state and an outcome of this machine"
            yield subject.finding("ambiguous-target", message, child.path, hint="rename the state")
    for child in subject.children(placed):
        yield from _check_targets(subject, child, siblings, outcomes)
        # Nearly all children lead each of their outcomes somewhere, and no other.
        own, connected = subject.outcomes.get(child.path), child.node.transitions
        if own is not None and (len(own) != len(connected) or not all(map(connected.__contains__, own))):
            yield from _check_outcomes(subject, child, own)


def _machine_outcomes(subject: AnalyzedBehavior, placed: NodeAt) -> Collection[str] | None:
    """Return the outcomes that a machine may have; None if its container accepts any."""
    if placed.container is None:
        return subject.behavior.outcomes
    return placed.node.transitions if placed.container.sequential is not None else None


def _check_targets(
    subject: AnalyzedBehavior, child: NodeAt, siblings: Mapping[str, NodeSpec], outcomes: Collection[str] | None
) -> Iterator[Finding]:
    for keys, target in child.targets.items():
        if outcomes is None or target in siblings or target in outcomes:
            continue
        message = f"`{target}` is neither a state nor an outcome of this machine"
        hint = did_you_mean(target, {*siblings, *outcomes})
        yield subject.finding("unknown-target", message, child.path, *keys, hint=hint)


def _check_outcomes(subject: AnalyzedBehavior, child: NodeAt, outcomes: Sequence[str]) -> Iterator[Finding]:
    connected = child.node.transitions
    for outcome in subject.possible(child) or ():
        if outcome not in connected and not _reported_inside(child.node):
            message = f"outcome `{outcome}` of `{child.name}` is not connected"
            hint = f"add `{outcome}: …` to its `transitions`"
            yield subject.finding("unconnected-outcome", message, child.path, hint=hint)
    for outcome in connected:
        if outcome in outcomes:
            continue
        fixed = child.node.sequential is None and child.node.concurrency is None
        code = "unknown-outcome" if fixed else "unused-outcome"
        message = f"`{child.name}` has no outcome `{outcome}`"
        keys = ("transitions", outcome)
        yield subject.finding(code, message, child.path, *keys, hint=did_you_mean(outcome, outcomes), at_key=True)


def _reported_inside(node: NodeSpec) -> bool:
    """Unconnected outcomes of a machine are reported at the transition inside it, the likely cause."""
    return node.sequential is not None


def _check_root(subject: AnalyzedBehavior) -> Iterator[Finding]:
    root = subject.nodes["root"]
    declared = subject.behavior.outcomes
    for keys, target in root.targets.items():
        if target not in declared:
            message = f"`{target}` is not an outcome of this behavior"
            yield subject.finding("unknown-target", message, "root", *keys, hint=did_you_mean(target, declared))
    if root.node.sequential is not None:
        return
    for outcome in subject.possible(root) or ():
        if outcome not in declared:
            message = f"outcome `{outcome}` of the root is not in `outcomes` of the behavior"
            yield subject.finding("unconnected-outcome", message, "root", hint=did_you_mean(outcome, declared))
