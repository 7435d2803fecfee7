"""One behavior under check: its nodes, the signatures of its states, and the outcomes of each node."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, field
from typing import NamedTuple

import msgspec

from engine.check.end_statuses import BOTH, SKIPPED, Status, Statuses, closed_statuses, end_statuses
from engine.check.finding import Finding, new_finding
from engine.check.gaps import DocumentGaps
from engine.check.node_in_run import in_run
from engine.document.behavior import Behavior
from engine.document.expression.expression import Template, compile_template
from engine.document.nodes.concurrency_condition import deciding
from engine.document.nodes.node_kind import WRAPPERS
from engine.document.nodes.node_spec import FOREACH_OUTCOMES, GUARD_TARGETS, TREE_KINDS, TREE_OUTCOMES, NodeSpec
from engine.document.signature import StateSignature, read_signature
from engine.document.state_catalogue import Catalogue, find_state
from engine.errors import ExpressionError, FlexcellError, RegistryError, StateError

GivenValues = Mapping[str, Template | ExpressionError]
_PARTS = frozenset((*TREE_KINDS, *WRAPPERS))


class NodeAt(msgspec.Struct, frozen=True, kw_only=True, eq=False, gc=False):
    """A node with its path inside its own document and the path of the container around it."""

    path: str
    name: str
    kind: str
    node: NodeSpec
    parent: str | None
    container: NodeSpec | None
    in_tree: bool
    """Whether the node is a direct child of `tree`, a composite or a decorator."""
    is_part: bool
    """True for composites, decorators and py_trees behaviours, which occur only in trees."""
    targets: Mapping[tuple[str, ...], str]
    """Its targets as in a machine, by the keys inside the node that name them."""
    given: GivenValues
    """The compiled values under `with`, by name."""

    @property
    def has_diverted_outcomes(self) -> bool:
        """Whether the targets of its guard, timeout and errors are outcomes of it, as in concurrency and foreach."""
        around = self.container
        return around is not None and (around.concurrency is not None or around.foreach is not None)


@dataclass(frozen=True, kw_only=True)
class AnalyzedBehavior:
    """A behavior with the derived data that the checks share.

    `base` is the path of its root in the run: `root`, or that of the reference that uses it.
    """

    behavior: Behavior
    base: str
    nodes: Mapping[str, NodeAt]
    due: tuple[NodeAt, ...]
    """The nodes that a check must look at by themselves: none that is disabled or of which `note_settled` knows."""
    inside: Mapping[str, tuple[NodeAt, ...]]
    """The nodes directly inside each container, by its path."""
    signatures: Mapping[str, StateSignature]
    """By state name; states that are unknown are absent."""
    unknown: Mapping[str, FlexcellError]
    """The errors of the absent states, by state name."""
    catalogue: Catalogue
    """The states and behaviours that documents may name."""
    references: Mapping[str, AnalyzedBehavior]
    """The behaviors referred to, by the path as written."""
    gaps: DocumentGaps
    """Its unreadable parts."""
    outcomes: Mapping[str, tuple[str, ...]] = field(default_factory=dict[str, tuple[str, ...]])
    """The outcomes of each node by path, as its container sees them; nodes of unknown states are absent."""
    nominal: Mapping[str, frozenset[str]] = field(default_factory=dict[str, frozenset[str]])
    """The nominal outcomes of each node, by path."""
    statuses: Mapping[str, Statuses] = field(default_factory=dict[str, Statuses])
    """The possible statuses of each part and leaf of a tree, by path."""
    disabled: Mapping[str, NodeSpec] = field(default_factory=dict[str, NodeSpec])
    """The disabled nodes as written, by path: `nodes` has what remains of them in a run."""

    @property
    def incomplete(self) -> bool:
        """True when a state or a reference is missing, so that its written keys are unknown."""
        refers = {placed.node.behavior for placed in self.due if placed.node.behavior is not None}
        return bool(self.unknown) or self.gaps.hides_values or not refers <= self.references.keys()

    @property
    def postorder(self) -> Iterator[NodeAt]:
        """The nodes, children before their containers."""
        return reversed(tuple(self.nodes.values()))

    def finding(
        self, code: str, message: str, path: str, *keys: str | int, hint: str = "", at_key: bool = False
    ) -> Finding:
        """Return a finding about the node at `path`, or about the value (or key) at `keys` inside it."""
        locate = self.behavior.key_position if at_key else self.behavior.position
        return new_finding(code, message, path=self.run_path(path), position=locate(path, *keys), hint=hint)

    def run_path(self, path: str) -> str:
        """Return the path in the run of the node at `path` of this document."""
        return self.base + path.removeprefix("root")

    def signature(self, node: NodeSpec) -> StateSignature | None:
        """Return the signature of a state node; None for other nodes and unknown states."""
        return self.signatures.get(node.state) if node.state is not None else None

    def referred(self, node: NodeSpec) -> AnalyzedBehavior | None:
        """Return the behavior that a node refers to; None for other nodes and unresolved references."""
        return self.references.get(node.behavior) if node.behavior is not None else None

    def possible(self, placed: NodeAt) -> tuple[str, ...] | None:
        """Return the possible outcomes of a node, without outcomes of a tree that never occur."""
        outcomes = self.outcomes.get(placed.path)
        if placed.node.tree is None or outcomes is None:
            return outcomes
        ends = self.statuses[self.inside[placed.path][0].path]
        # A tree whose root is skipped succeeds.
        seen = {"success" if end == "skipped" else end for end in ends}
        return tuple(outcome for outcome in outcomes if outcome not in TREE_OUTCOMES or outcome in seen)

    def children(self, placed: NodeAt) -> tuple[NodeAt, ...]:
        """Return the nodes directly inside a container."""
        return self.inside.get(placed.path, ())


def analyze_behaviors(behavior: Behavior, catalogue: Catalogue) -> tuple[AnalyzedBehavior, ...]:
    """Return the behavior and its references, each once, in the order of their first reference."""
    bases: dict[int, str] = {}
    order: list[Behavior] = []
    due = [(behavior, "root")]
    for current, base in due:
        if id(current) in bases:
            continue
        bases[id(current)] = base
        order.append(current)
        for path, node in current.nodes() if current.references else ():
            if node.behavior is not None and node.behavior in current.references:
                below = f"{base}{path.removeprefix('root')}/root"
                due.append((current.references[node.behavior], below))
    made: dict[int, AnalyzedBehavior] = {}
    return tuple(_make(current, catalogue, bases, made) for current in order)


class _OwnFacts(NamedTuple):
    """What the checks need to know of a node and follows from it alone."""

    targets: dict[tuple[str, ...], str]
    given: GivenValues


def _own_facts(node: NodeSpec) -> _OwnFacts:
    return _OwnFacts(_targets(node), {name: template(value) for name, value in node.parameters.items()})


def _targets(node: NodeSpec) -> dict[tuple[str, ...], str]:
    return {**{("transitions", outcome): to for outcome, to in node.transitions.items()}, **diversions(node)}


def diversions(node: NodeSpec) -> dict[tuple[str, ...], str]:
    """Return the targets of guard, timeout and on_error of a node, by their keys inside the node."""
    found: dict[tuple[str, ...], str] = {}
    if node.guard is not None and node.guard.to is not None:
        found["guard", "to"] = node.guard.to
    if node.timeout is not None and node.timeout.to is not None:
        found["timeout", "to"] = node.timeout.to
    if node.on_error is not None:
        found["on_error",] = node.on_error
    return found


def template(value: object) -> Template | ExpressionError:
    """Compile a value of a document, or return its error."""
    try:
        return compile_template(value)
    except ExpressionError as error:
        # Without its traceback, whose frames would keep the checked objects alive.
        return ExpressionError(error.message, where=error.where, hint=error.hint)


def is_constant(given: GivenValues) -> bool:
    """Return whether no value contains an expression."""
    return all(isinstance(found, Template) and found.constant for found in given.values())


def leaf_success(placed: NodeAt, subject: AnalyzedBehavior) -> frozenset[str]:
    """Return the outcomes of a leaf of a tree that mean SUCCESS there."""
    return frozenset(placed.node.success) or subject.nominal[placed.path]


def _make(
    behavior: Behavior, catalogue: Catalogue, bases: Mapping[int, str], made: dict[int, AnalyzedBehavior]
) -> AnalyzedBehavior:
    known = made.get(id(behavior))
    if known is not None:
        return known
    references = {name: _make(other, catalogue, bases, made) for name, other in behavior.references.items()}
    nodes, inside = _placed(behavior)
    signatures, unknown = _signatures(behavior, nodes, catalogue)
    outcomes: dict[str, tuple[str, ...]] = {}
    nominal: dict[str, frozenset[str]] = {}
    statuses: dict[str, Statuses] = {}
    subject = AnalyzedBehavior(
        behavior=behavior,
        base=bases[id(behavior)],
        nodes=nodes,
        due=_due(nodes.values(), signatures),
        disabled={path: node for path, node in behavior.nodes() if node.is_disabled and path in nodes},
        inside=inside,
        signatures=signatures,
        unknown=unknown,
        catalogue=catalogue,
        references=references,
        gaps=DocumentGaps(behavior),
        outcomes=outcomes,
        nominal=nominal,
        statuses=statuses,
    )
    # Nothing hides the outcomes of a state in a document without gaps.
    ends = {name: _ends_of(each) for name, each in signatures.items()} if not behavior.gaps else {}
    # Children before containers: the outcomes of a container follow from its children.
    for placed in subject.postorder:
        path = placed.path
        known_ends = ends.get(placed.node.state) if placed.node.state is not None else None
        if known_ends is not None:
            own, nominal[path] = known_ends
            # Without other targets than those of its outcomes it has no others outside.
            outcomes[path] = own if len(placed.targets) == len(placed.node.transitions) else _seen_outside(placed, own)
            if placed.in_tree:
                statuses[path] = _statuses(placed, subject)
            continue
        own = _own_outcomes(placed, subject)
        if own is not None and not (subject.gaps.hides_course(path) and placed.has_diverted_outcomes):
            outcomes[path] = _seen_outside(placed, own)
        nominal[path] = _nominal(placed, subject)
        if placed.in_tree:
            statuses[path] = _statuses(placed, subject)
    made[id(behavior)] = subject
    return subject


def _placed(behavior: Behavior) -> tuple[dict[str, NodeAt], dict[str, tuple[NodeAt, ...]]]:
    nodes: dict[str, NodeAt] = {}
    inside: dict[str, tuple[NodeAt, ...]] = {}
    due = [_node_at("root", "root", behavior.root, None)]
    while due:
        placed = due.pop()
        path = placed.path
        nodes[path] = placed
        children = placed.node.children.items()
        if children:
            inside[path] = found = tuple(
                [_node_at(f"{path}/{name}", name, in_run(child), placed) for name, child in children]
            )
            due += found[::-1]
    return nodes, inside


def _node_at(path: str, name: str, node: NodeSpec, around: NodeAt | None) -> NodeAt:
    kind, facts = node.kind, node.derived(_own_facts)
    return NodeAt(
        path=path,
        name=name,
        kind=kind,
        node=node,
        parent=around.path if around is not None else None,
        container=around.node if around is not None else None,
        in_tree=around is not None and (around.is_part or around.kind == "tree"),
        is_part=kind in _PARTS,
        targets=facts.targets,
        given=facts.given,
    )


def _signatures(
    behavior: Behavior, nodes: Mapping[str, NodeAt], catalogue: Catalogue
) -> tuple[dict[str, StateSignature], dict[str, FlexcellError]]:
    signatures: dict[str, StateSignature] = {}
    unknown: dict[str, FlexcellError] = {}
    for placed in nodes.values():
        name = placed.node.state
        if name is None or name in signatures or name in unknown or placed.node.is_disabled:
            continue
        try:
            signatures[name] = read_signature(find_state(catalogue, name, behavior.classes))
        except (RegistryError, StateError) as error:
            unknown[name] = error
    return signatures, unknown


def note_settled(subject: AnalyzedBehavior, findings: Iterable[Finding]) -> None:
    """Note the states that need no check by themselves again, wherever they are: nothing was found at them.

    They read no key and have no policies, so what is found in them follows from their class and their constants.
    """
    reported = {finding.path for finding in findings}
    for placed in subject.due:
        node, signature = placed.node, subject.signature(placed.node)
        if signature is None or signature.inputs or subject.run_path(placed.path) in reported:
            continue
        policies = node.guard or node.retry or node.post or node.resume or node.autonomy or node.success
        if not policies and not node.inputs and is_constant(placed.given):
            node.clear_of.add((note_settled, signature.state))


def _due(nodes: Iterable[NodeAt], signatures: Mapping[str, StateSignature]) -> tuple[NodeAt, ...]:
    settled: dict[str | None, object] = {name: (note_settled, found.state) for name, found in signatures.items()}
    own = (placed for placed in nodes if not placed.node.is_disabled)
    return tuple([placed for placed in own if settled.get(placed.node.state) not in placed.node.clear_of])


def _ends_of(signature: StateSignature) -> tuple[tuple[str, ...], frozenset[str]]:
    """Return the outcomes of a state, and the nominal ones."""
    return signature.outcomes, frozenset(signature.success or signature.outcomes)


def _seen_outside(placed: NodeAt, own: tuple[str, ...]) -> tuple[str, ...]:
    # In a concurrency or foreach container a guard, timeout or error gives the child an outcome.
    leading = diversions(placed.node).values() if placed.has_diverted_outcomes else ()
    return tuple(dict.fromkeys((*own, *leading))) if leading else own


def _own_outcomes(placed: NodeAt, subject: AnalyzedBehavior) -> tuple[str, ...] | None:
    node = placed.node
    if node.is_disabled:
        return (node.passes_with,)
    if subject.gaps.hides_ends(placed.path) or subject.gaps.hides_inside(placed.path):
        return None
    if node.state is not None:
        signature = subject.signature(node)
        return signature.outcomes if signature is not None else None
    if node.behavior is not None:
        referred = subject.behavior.references.get(node.behavior)
        return referred.outcomes if referred is not None else None
    if node.concurrency is not None:
        named = [rule.outcome for rule in deciding(node.concurrency.rules)]
        return tuple(dict.fromkeys([*named, *([node.concurrency.otherwise] if node.concurrency.otherwise else [])]))
    if node.foreach is not None:
        return FOREACH_OUTCOMES
    if node.sequential is None:
        return TREE_OUTCOMES
    return node.derived(_machine_outcomes)


def _machine_outcomes(node: NodeSpec) -> tuple[str, ...]:
    led_to = [
        target for child in node.children.values() for target in in_run(child).derived(_own_facts).targets.values()
    ]
    return tuple(dict.fromkeys(target for target in led_to if target not in node.children))


def _nominal(placed: NodeAt, subject: AnalyzedBehavior) -> frozenset[str]:
    """Return the nominal outcomes of a node: declared as success by its class or document, or derived."""
    node = placed.node
    if node.is_disabled:
        return frozenset((node.passes_with,))
    if node.state is not None:
        signature = subject.signature(node)
        return _ends_of(signature)[1] if signature is not None else frozenset()
    if node.behavior is not None:
        referred = subject.behavior.references.get(node.behavior)
        return frozenset(referred.success or referred.outcomes) if referred is not None else frozenset()
    if node.concurrency is not None:
        good = {child.name: subject.nominal[child.path] for child in subject.children(placed)}
        rules = deciding(node.concurrency.rules)
        return frozenset(
            rule.outcome for rule in rules if rule.asks_only_for(lambda name, due: due in good.get(name, ()))
        )
    if node.foreach is not None:
        return frozenset(FOREACH_OUTCOMES[:1])
    if node.sequential is None:
        return frozenset(TREE_OUTCOMES[:1])
    return _reached_nominally(placed, node.sequential.initial, subject)


def _reached_nominally(placed: NodeAt, initial: str, subject: AnalyzedBehavior) -> frozenset[str]:
    reached: set[str] = set()
    due = [initial]
    children = placed.node.children
    while due:
        name = due.pop()
        if name in reached:
            continue
        reached.add(name)
        child = in_run(children[name]) if name in children else None
        if child is not None:
            good = subject.nominal[f"{placed.path}/{name}"]
            due += [target for outcome, target in child.transitions.items() if outcome in good]
            due += [child.guard.to] if child.guard is not None and child.guard.to is not None else []
    return frozenset(reached.difference(children))


def _statuses(placed: NodeAt, subject: AnalyzedBehavior) -> Statuses:
    if placed.node.is_disabled:
        return SKIPPED
    if subject.gaps.hides_ends(placed.path) or subject.gaps.hides_course(placed.path):
        return BOTH
    if placed.is_part:
        inside = [(child.name, subject.statuses[child.path]) for child in subject.children(placed)]
        ends = end_statuses(placed.node, inside)
        return ends | closed_statuses(placed.node)
    outcomes = subject.outcomes.get(placed.path)
    if not outcomes:
        return BOTH
    good = leaf_success(placed, subject)
    led = diversions(placed.node).values()
    found: set[Status] = {"success" if outcome in good else "failure" for outcome in outcomes}
    return frozenset([*found, *(status for status in GUARD_TARGETS if status in led)])
