"""One behavior under check: its nodes, the signatures of its states, and how each node can end."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field

from engine.check.finding import Finding, new_finding
from engine.document.behavior import Behavior
from engine.document.node import FOREACH_OUTCOMES, TREE_OUTCOMES, Node
from engine.document.signature import StateSignature, read_signature
from engine.errors import RegistryError, StateError
from engine.nearness import near_names
from engine.registry import state_by_path
from engine.state import State

Catalogue = Mapping[str, type[State]]


@dataclass(frozen=True, kw_only=True)
class Placed:
    """A node with its path inside its own document and the path of the container around it."""

    path: str
    node: Node
    parent: str | None
    container: Node | None

    @property
    def name(self) -> str:
        """The last part of the path."""
        return self.path.rpartition("/")[2]


@dataclass(frozen=True, kw_only=True)
class Subject:
    """A behavior with what the checks need to know about it, worked out once.

    `base` is the path of its root in the run: `root`, or that of the reference that uses it.
    """

    behavior: Behavior
    base: str
    nodes: Mapping[str, Placed]
    signatures: Mapping[str, StateSignature]
    """By state name; states that are unknown are absent."""
    unknown: Mapping[str, str]
    """What is wrong with the states that are absent, by state name."""
    outcomes: Mapping[str, tuple[str, ...]] = field(default_factory=dict[str, tuple[str, ...]])
    """The outcomes of each node by path, as its container sees them; nodes of unknown states are absent."""

    def finding(
        self, code: str, message: str, path: str, *keys: str | int, hint: str = "", at_key: bool = False
    ) -> Finding:
        """Make a finding about the node at `path`, or about the value (or key) at `keys` inside it."""
        locate = self.behavior.key_position if at_key else self.behavior.position
        run_path = self.base + path.removeprefix("root")
        return new_finding(code, message, path=run_path, position=locate(path, *keys), hint=hint)

    def signature(self, node: Node) -> StateSignature | None:
        """Return what the class of a state node declares, None for other nodes and unknown states."""
        return self.signatures.get(node.state) if node.state is not None else None

    def children(self, placed: Placed) -> Iterator[Placed]:
        """Go through the nodes directly inside a container."""
        return (self.nodes[f"{placed.path}/{name}"] for name in placed.node.children)


def new_subject(behavior: Behavior, catalogue: Catalogue, *, base: str = "root") -> Subject:
    """Work out everything that the checks share."""
    nodes: dict[str, Placed] = {}
    for path, node in behavior.nodes():
        parent = path.rpartition("/")[0] or None
        container = nodes[parent].node if parent is not None else None
        nodes[path] = Placed(path=path, node=node, parent=parent, container=container)
    signatures, unknown = _signatures(behavior, catalogue)
    outcomes: dict[str, tuple[str, ...]] = {}
    # Children before containers: a container's outcomes follow from those inside it.
    for placed in reversed(nodes.values()):
        found = _outcomes(placed, behavior, signatures)
        if found is not None:
            outcomes[placed.path] = found
    return Subject(behavior=behavior, base=base, nodes=nodes, signatures=signatures, unknown=unknown, outcomes=outcomes)


def targets(node: Node) -> dict[tuple[str, ...], str]:
    """Return where a node in a machine can lead, by the keys inside the node that say so."""
    found: dict[tuple[str, ...], str] = {("transitions", outcome): to for outcome, to in node.transitions.items()}
    if node.guard is not None and node.guard.to is not None:
        found["guard", "to"] = node.guard.to
    if node.timeout is not None and node.timeout.to is not None:
        found["timeout", "to"] = node.timeout.to
    if node.on_error is not None:
        found["on_error",] = node.on_error
    return found


def _signatures(behavior: Behavior, catalogue: Catalogue) -> tuple[dict[str, StateSignature], dict[str, str]]:
    signatures: dict[str, StateSignature] = {}
    unknown: dict[str, str] = {}
    for _, node in behavior.nodes():
        name = node.state
        if name is None or name in signatures or name in unknown:
            continue
        try:
            state = catalogue.get(name) or (state_by_path(name) if ":" in name else None)
            if state is None:
                unknown[name] = near_names(name, catalogue)
            else:
                signatures[name] = read_signature(state)
        except (RegistryError, StateError) as error:
            unknown[name] = str(error)
    return signatures, unknown


def _outcomes(placed: Placed, behavior: Behavior, signatures: Mapping[str, StateSignature]) -> tuple[str, ...] | None:
    own = _own_outcomes(placed.node, behavior, signatures)
    container = placed.container
    if own is None or container is None or (container.concurrency is None and container.foreach is None):
        return own
    # In a concurrency or foreach container a timeout or error gives the child an outcome that it sees.
    return tuple(dict.fromkeys((*own, *(targets(placed.node).values()))))


def _own_outcomes(node: Node, behavior: Behavior, signatures: Mapping[str, StateSignature]) -> tuple[str, ...] | None:
    if node.state is not None:
        signature = signatures.get(node.state)
        return signature.outcomes if signature is not None else None
    if node.behavior is not None:
        referred = behavior.references.get(node.behavior)
        return referred.outcomes if referred is not None else None
    if node.concurrency is not None:
        named = [rule.outcome for rule in node.concurrency.rules]
        return tuple(dict.fromkeys([*named, *([node.concurrency.otherwise] if node.concurrency.otherwise else [])]))
    if node.foreach is not None:
        return FOREACH_OUTCOMES
    if node.sequential is None:
        return TREE_OUTCOMES
    leading = [target for child in node.children.values() for target in targets(child).values()]
    return tuple(dict.fromkeys(target for target in leading if target not in node.children))
