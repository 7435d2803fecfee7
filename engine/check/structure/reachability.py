"""Checks that every state of a machine is reachable and can reach an outcome of the machine."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping

from engine.check.analyzed_behavior import AnalyzedBehavior, NodeAt
from engine.check.finding import Finding
from engine.wording.suggestions import did_you_mean


def check_reachability(subject: AnalyzedBehavior) -> Iterator[Finding]:
    """Find missing initial states, unreachable states, and states from which no outcome is reachable."""
    for placed in subject.due:
        machine = placed.node.sequential
        if machine is None:
            continue
        if machine.initial not in machine.states:
            message = f"the initial state `{machine.initial}` does not exist"
            hint = did_you_mean(machine.initial, machine.states)
            yield subject.finding("missing-initial", message, placed.path, placed.node.kind, "initial", hint=hint)
            continue
        if check_reachability in placed.node.clear_of:
            continue
        found = list(_check_machine(subject, placed, machine.initial))
        if not found:
            placed.node.clear_of.add(check_reachability)
        yield from found


def _check_machine(subject: AnalyzedBehavior, placed: NodeAt, initial: str) -> Iterator[Finding]:
    leads = {child.name: tuple(child.targets.values()) for child in subject.children(placed)}
    reached = _reachable([initial], leads)
    for name in leads:
        if name not in reached:
            hint = "remove it, or add a transition to it"
            yield subject.finding(
                "unreachable-node", f"no transition leads to `{name}`", f"{placed.path}/{name}", hint=hint
            )
    comes_from: dict[str, list[str]] = {}
    for name, following in leads.items():
        for target in following:
            comes_from.setdefault(target, []).append(name)
    ends = [target for target in comes_from if target not in leads]
    can_end = _reachable(ends, comes_from)
    # States without transitions are reported as unconnected; a trap has transitions but no exit.
    trap = [name for name in leads if name in reached and name not in can_end and leads[name]]
    if trap:
        shown = ", ".join(f"`{name}`" for name in trap[:5])
        message = f"from {shown}{' and others' if len(trap) > 5 else ''} no outcome of this machine can be reached"
        hint = "add a transition out of the loop, unless it is intended to run until it is stopped"
        yield subject.finding("no-path-to-outcome", message, f"{placed.path}/{trap[0]}", hint=hint)


def _reachable(start: Iterable[str], leads: Mapping[str, Iterable[str]]) -> set[str]:
    reached: set[str] = set()
    due = list(start)
    while due:
        name = due.pop()
        if name not in reached:
            reached.add(name)
            due += leads.get(name, ())
    return reached
