"""Checks the condition of a breakpoint at a node, and says which names it may use there."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import msgspec

from engine.check.analyzed_behavior import AnalyzedBehavior, NodeAt, analyze_behaviors
from engine.check.flow.definition_sites import DefinitionSites
from engine.check.flow.key_reads import assignments, key_reads
from engine.check.flow.type_inference import BehaviorDataFlows, TypeInference
from engine.check.flow.userdata_flow import DataFlow
from engine.check.flow.value_type import TypeFit, describe_inferred_type, type_fit
from engine.document.behavior import Behavior
from engine.document.expression.expression import Template, compile_template
from engine.document.state_catalogue import Catalogue
from engine.errors import ExpressionError
from engine.wording.suggestions import did_you_mean


class ConditionCheck(msgspec.Struct, frozen=True, kw_only=True):
    """What is wrong with a condition; empty if nothing is. `names` are the keys and parameters that it may use."""

    problem: str = ""
    hint: str = ""
    names: tuple[str, ...] = ()


def check_condition(
    behavior: Behavior, catalogue: Catalogue, path: str, condition: str, *, after: bool = False
) -> ConditionCheck:
    """Check a condition as an expression that is evaluated at the gate of a node.

    Args:
        behavior: The behavior of the run.
        catalogue: The states by name.
        path: The node in the run; with wildcards, or of an unknown node, only the syntax is checked.
        condition: The expression, with or without `${…}`; an empty one has no problem.
        after: At its outcome instead of before its entry, where what it has written is defined.
    """
    place = _place(analyze_behaviors(behavior, catalogue), path)
    names = place.names(after=after) if place is not None else ()
    if not condition.strip():
        return ConditionCheck(names=names)
    try:
        template = compile_template(condition if "${" in condition else f"${{{condition}}}")
        problem, hint = _problem(place, template, names, after=after) if place is not None else ("", "")
    except ExpressionError as error:
        problem, hint = error.message, error.hint or ""
    return ConditionCheck(problem=problem, hint=hint, names=names)


@dataclass(frozen=True, kw_only=True)
class _Place:
    """A node, and the data flow of the behavior that it is in."""

    placed: NodeAt
    subject: AnalyzedBehavior
    flows: BehaviorDataFlows

    def names(self, *, after: bool) -> tuple[str, ...]:
        """Return the names that may be defined at its gate, sorted."""
        flow = self.flows.of(self.subject)
        before = flow.before.get(self.placed.path)
        keys = dict.fromkeys(_keys(self.subject))
        # A node that no path reaches has no facts; a hot change may make one.
        defined = [key for key in keys if before is None or before & flow.sites.defined_bits(key)]
        own = _written(self.subject, self.placed) if after else ()
        return tuple(sorted({*defined, *own}))


def _problem(place: _Place, template: Template, names: Sequence[str], *, after: bool) -> tuple[str, str]:
    missing = sorted(template.names.difference(names))
    if missing:
        where = "after" if after else "before"
        return f"`{missing[0]}` is not defined {where} `{place.placed.name}`", did_you_mean(missing[0], names)
    own = set(_written(place.subject, place.placed)) if after else set[str]()
    if template.names & own:
        return "", ""  # of what the node writes, the type is known at its outcome only
    types = TypeInference(place.flows.of(place.subject), place.flows)
    wrong = [kind for kind in types.of_value(template.value, place.placed.path) if type_fit(kind, bool) is TypeFit.NO]
    if not wrong:
        return "", ""
    return f"a condition is true or false, and this is {describe_inferred_type(wrong[0])}", "use a comparison"


def _place(subjects: Sequence[AnalyzedBehavior], path: str) -> _Place | None:
    """Return the node at a path of a run, which may lead through references."""
    flows = {
        id(each): DataFlow(
            each, DefinitionSites(dict.fromkeys((*_keys(each), *(read.key for read in key_reads(each)))))
        )
        for each in subjects
    }
    subject, here = subjects[0], path
    while here not in subject.nodes:
        around = next((each for each in subject.nodes.values() if here.startswith(f"{each.path}/root")), None)
        inner = subject.referred(around.node) if around is not None else None
        if around is None or inner is None:
            return None
        subject, here = inner, here.removeprefix(f"{around.path}/")
    return _Place(placed=subject.nodes[here], subject=subject, flows=BehaviorDataFlows(flows))


def _keys(subject: AnalyzedBehavior) -> Iterator[str]:
    """Yield the names that a behavior defines somewhere."""
    yield from subject.behavior.document.parameters
    yield from subject.behavior.document.userdata
    for placed in subject.nodes.values():
        yield from placed.node.userdata
        yield from _written(subject, placed)
        if placed.node.foreach is not None:
            yield from (name for name in (placed.node.foreach.item, placed.node.foreach.index) if name is not None)


def _written(subject: AnalyzedBehavior, placed: NodeAt) -> Iterator[str]:
    """Yield the keys that a node writes."""
    signature = subject.signature(placed.node)
    yield from placed.node.outputs.values()
    yield from (
        name for name in (signature.outputs if signature is not None else ()) if name not in placed.node.outputs
    )
    yield from (key for _, _, key in assignments(placed))
    yield from placed.node.foreach.collect.values() if placed.node.foreach is not None else ()
