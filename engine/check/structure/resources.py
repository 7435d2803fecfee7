"""Checks that concurrent nodes do not command the same device."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from engine.check.analyzed_behavior import AnalyzedBehavior, NodeAt
from engine.check.finding import Finding
from engine.check.state_instances import UNKNOWN_PLACEHOLDER, given_values, try_make_state
from engine.document.signature import StateSignature

_NONE: frozenset[str] = frozenset()
_SIDE_BY_SIDE = ("concurrency", "parallel", "while_do_else")
"""In the last one only the condition runs concurrently with the others."""
_MOST_USES = 20_000
"""Maximum number of behavior references evaluated, each with its own parameters."""


def check_resources(subject: AnalyzedBehavior) -> Iterator[Finding]:
    """Find resources that two branches of a concurrency or parallel use, as far as they are constant."""
    if not any(placed.kind in _SIDE_BY_SIDE for placed in subject.due):
        return
    used = _Resources().used(subject, dict.fromkeys(subject.behavior.parameters, UNKNOWN_PLACEHOLDER))
    for placed in subject.due:
        if placed.kind not in _SIDE_BY_SIDE:
            continue
        owners: dict[str, NodeAt] = {}
        children = subject.children(placed)
        for child in children:
            for resource in sorted(used[child.path]):
                alone = placed.kind == "while_do_else" and child is not children[0]
                other = owners.get(resource, child) if alone else owners.setdefault(resource, child)
                if other is not child:
                    message = f"`{other.name}` and `{child.name}` run concurrently and both command `{resource}`"
                    yield subject.finding("shared-resource", message, child.path, hint="run them in sequence")


class _Resources:
    """The resources of nodes; those of a referred behavior are computed once per set of parameters."""

    def __init__(self) -> None:
        self._uses = 0
        self._of_references: dict[tuple[int, str], frozenset[str]] = {}

    def used(self, subject: AnalyzedBehavior, known: Mapping[str, object]) -> dict[str, frozenset[str]]:
        """Return the resources of every node and everything inside it, by path.

        Args:
            subject: The behavior.
            known: Its parameters; those known only in a run are `UNKNOWN_PLACEHOLDER`.
        """
        used: dict[str, frozenset[str]] = {}
        for placed in subject.postorder:
            own, children = self._own(subject, placed, known), subject.children(placed)
            used[placed.path] = own.union(*[used[child.path] for child in children]) if children else own
        return used

    def _own(self, subject: AnalyzedBehavior, placed: NodeAt, known: Mapping[str, object]) -> frozenset[str]:
        signature = subject.signature(placed.node)
        if signature is not None:
            # Most states command no device: only classes that declare resources are instantiated.
            if not signature.commands_hardware:
                return _NONE
            return _resources_of(signature, given_values(placed, known))
        referred = subject.referred(placed.node)
        if referred is None or self._uses > _MOST_USES:
            return frozenset()
        inner = {
            **dict.fromkeys(referred.behavior.parameters, UNKNOWN_PLACEHOLDER),
            **given_values(placed, known),
        }
        key = (id(referred), repr(sorted(inner.items())))
        if key not in self._of_references:
            self._uses += 1
            self._of_references[key] = self.used(referred, inner)["root"]
        return self._of_references[key]


def _resources_of(signature: StateSignature, given: Mapping[str, object]) -> frozenset[str]:
    """Return the resources that the state commands."""
    state = try_make_state(signature, given)
    try:
        return (
            frozenset(name for name in state.resources() if UNKNOWN_PLACEHOLDER not in name)
            if state is not None
            else _NONE
        )
    except Exception:
        # A custom class may fail with placeholders for unknown values: its resources are then unknown.
        return _NONE
