"""Checks parts of behavior trees: children that never run, parts that never end, py_trees behaviours."""

from __future__ import annotations

import inspect
from collections.abc import Iterator

from engine.check.analyzed_behavior import AnalyzedBehavior, NodeAt
from engine.check.finding import Finding
from engine.check.structure.instant_loops import InstantOutcomes
from engine.document.expression.expression import Template
from engine.document.nodes.node_kind import SLOTS
from engine.document.nodes.node_spec import TREE_OUTCOMES, NodeSpec
from engine.document.nodes.tree_composites import CompositeSpec, ParallelSpec
from engine.document.signature import StateSignature
from engine.errors import ModuleNotAllowed, RegistryError
from engine.wording.suggestions import did_you_mean


def check_trees(subject: AnalyzedBehavior) -> Iterator[Finding]:
    """Find defects of trees that are known before the first tick."""
    for placed in subject.due:
        if placed.in_tree and placed.is_part:
            yield from _check_dead_children(subject, placed)
            yield from _check_end(subject, placed)
            yield from _check_restarts(subject, placed)
            yield from _check_watching(subject, placed)
            if placed.node.behaviour is not None:
                yield from _check_behaviour(subject, placed, placed.node.behaviour)


def _check_dead_children(subject: AnalyzedBehavior, placed: NodeAt) -> Iterator[Finding]:
    if placed.kind in SLOTS:
        yield from _check_dead_branches(subject, placed)
    if placed.node.sequence is None and placed.node.selector is None:
        return
    onward, always = ("success", "fails") if placed.node.sequence is not None else ("failure", "succeeds")
    children = subject.children(placed)
    for number, child in enumerate(children[:-1]):
        statuses = subject.statuses[child.path]
        if statuses and onward not in statuses and "skipped" not in statuses:
            names = ", ".join(f"`{later.name}`" for later in children[number + 1 :][:3])
            message = f"{names} cannot run: `{child.name}` before it always {always}"
            hint = "change the order, or declare the outcomes that mean SUCCESS with `success`"
            yield subject.finding("unreachable-node", message, children[number + 1].path, hint=hint)
            return


def _check_dead_branches(subject: AnalyzedBehavior, placed: NodeAt) -> Iterator[Finding]:
    """Find branches that an `if_then_else` or `while_do_else` never chooses."""
    condition, *branches = subject.children(placed)
    possible = subject.statuses[condition.path]
    for branch, chosen in zip(branches, TREE_OUTCOMES, strict=False):
        if possible and chosen not in possible and not (chosen == "failure" and "skipped" in possible):
            always = "fails" if chosen == "success" else "succeeds"
            message = f"`{branch.name}` cannot run: `{condition.name}` always {always}"
            hint = "change the condition, or declare the outcomes that mean SUCCESS with `success`"
            yield subject.finding("unreachable-node", message, branch.path, hint=hint)


def _check_end(subject: AnalyzedBehavior, placed: NodeAt) -> Iterator[Finding]:
    inside = [subject.statuses[child.path] for child in subject.children(placed)]
    if subject.statuses[placed.path] or not all(inside):
        return
    shown = " or ".join(sorted(inside[0]))
    decorator = placed.node.decorator
    reason = decorator.why_endless(shown) if decorator is not None else "does not end with its children"
    hint = "change the mapping or the status; otherwise the tree runs until it is stopped"
    message = f"this `{placed.kind}` never ends: it {reason}"
    yield subject.finding("never-ends", message, placed.path, placed.kind, hint=hint, at_key=True)


def _check_restarts(subject: AnalyzedBehavior, placed: NodeAt) -> Iterator[Finding]:
    parallel = placed.node.parallel
    if not isinstance(parallel, ParallelSpec) or parallel.counts or parallel.synchronise or parallel.policy == "one":
        return
    needed = [child for child in subject.children(placed) if parallel.policy == "all" or child.name in parallel.policy]
    ends = InstantOutcomes(subject).ends
    slow = [f"`{child.name}`" for child in needed if not ends[child.path]]
    if len(slow) > 1:
        message = f"{', '.join(slow[:3])} take time and must succeed in the same tick; until then they restart"
        hint = "remove `synchronise: false`: a child that has succeeded then waits for the others"
        yield subject.finding("restarted-children", message, placed.path, "parallel", "synchronise", hint=hint)


def _check_watching(subject: AnalyzedBehavior, placed: NodeAt) -> Iterator[Finding]:
    """Check the leaves of a part of a tree, which a composite without memory may repeat."""
    for child in subject.children(placed):
        signature = subject.signature(child.node)
        if signature is None:
            continue
        is_action = signature.commands_hardware
        in_front = _is_in_front(subject, child)
        if child.node.every is not None and (is_action or not in_front):
            what = "an action" if is_action else "not in front of an action"
            message = f"`{child.name}` is {what}, so `every` has no effect"
            hint = "it applies to checks before an action in a `sequence` or `selector` without memory, or in `while`"
            yield subject.finding("idle-every", message, child.path, "every", hint=hint, at_key=True)
        elif in_front and not is_action and not _is_repeated(child, signature):
            message = f"the check `{child.name}` is not repeated while the nodes after it run"
            hint = f"set a period, `every: 200 ms`, or declare `observes` in the class of `{signature.name}`"
            yield subject.finding("unwatched-check", message, child.path, "state", hint=hint)


def _is_repeated(placed: NodeAt, signature: StateSignature) -> bool:
    reads = any(isinstance(given, Template) and given.names for given in placed.given.values())
    return signature.instant or signature.observes or placed.node.every is not None or reads or bool(signature.inputs)


def _is_in_front(subject: AnalyzedBehavior, placed: NodeAt) -> bool:
    """Return whether a node, or a part around it, precedes others in a composite without memory."""
    below = placed
    while below.parent is not None and below.in_tree:
        around = subject.nodes[below.parent]
        children = subject.children(around)
        if _without_memory(around.node) and below.path != children[-1].path:
            return True
        if around.node.while_do_else is not None and below.path == children[0].path:
            return True
        below = around
    return False


def _without_memory(node: NodeSpec) -> bool:
    group = node.sequence or node.selector
    return isinstance(group, CompositeSpec) and not group.memory


def _check_behaviour(subject: AnalyzedBehavior, placed: NodeAt, name: str) -> Iterator[Finding]:
    # Imported on demand: py_trees loads slowly, and most trees have no behaviour of it.
    from engine.runtime.tree.behaviour_catalogue import find_behaviour

    try:
        found = find_behaviour(subject.catalogue, name, subject.behavior.classes)
    except RegistryError as error:
        code = "module-not-allowed" if isinstance(error, ModuleNotAllowed) else "broken-behaviour"
        yield subject.finding(code, error.message, placed.path, "behaviour", hint=error.hint or "")
        return
    yield from _check_arguments(subject, placed, name, found)


def _check_arguments(subject: AnalyzedBehavior, placed: NodeAt, name: str, kind: type[object]) -> Iterator[Finding]:
    """Compare `with` with the constructor; the engine passes `name` if it is missing."""
    try:
        known = inspect.signature(kind).parameters
    except (TypeError, ValueError):
        return  # some classes have no introspectable signature
    if any(parameter.kind is parameter.VAR_KEYWORD for parameter in known.values()):
        return
    given = placed.node.parameters
    for argument in given:
        if argument not in known:
            message = f"`{name}` has no parameter `{argument}`"
            hint = did_you_mean(argument, known)
            yield subject.finding("unknown-parameter", message, placed.path, "with", argument, hint=hint, at_key=True)
    for argument, parameter in known.items():
        required = parameter.default is parameter.empty and parameter.kind is not parameter.VAR_POSITIONAL
        if required and argument not in given and argument != "name":
            message = f"`{name}` requires the parameter `{argument}`"
            yield subject.finding("missing-parameter", message, placed.path, hint=f"add `{argument}: …` to `with`")
