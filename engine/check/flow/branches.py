"""How writes of branches that run side by side are merged, for each end of their container."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence

from engine.check.flow.effect import NOTHING, Effect, either
from engine.check.flow.graph import Way
from engine.check.flow.site import Sites
from engine.check.subject import Placed

Ways = Mapping[str, Sequence[Way]]


def concurrency_ends(
    placed: Placed, children: Sequence[Placed], ways: Ways, entry: int, sites: Sites
) -> dict[str, int]:
    """Return what holds at each end of a concurrency container."""
    container = placed.node.concurrency
    writers = _writers(children, ways)
    ends: dict[str, int] = {}
    for rule in container.rules if container is not None else ():
        effects = [_ended(child, ways, rule.when.get(child.name)) for child in writers]
        ends[rule.outcome] = ends.get(rule.outcome, 0) | _merged(entry, effects, sites)
    if container is not None and container.otherwise is not None:
        effects = [either(way.effect for way in ways[child.path]) for child in writers]
        ends[container.otherwise] = ends.get(container.otherwise, 0) | _merged(entry, effects, sites)
    return ends


def parallel_ends(placed: Placed, children: Sequence[Placed], ways: Ways, entry: int, sites: Sites) -> dict[str, int]:
    """Return what holds when a parallel of a tree succeeds and when it fails."""
    group = placed.node.parallel
    policy = "all" if group is None or isinstance(group, tuple) else group.policy
    writers = _writers(children, ways)
    due: list[Sequence[Placed]] = [[child for child in children if policy == "all" or child.name in policy]]
    if policy == "one":
        due = [[child] for child in children]
    succeeded = 0
    for succeeding in due:
        effects = [_ended(child, ways, "success" if child in succeeding else None) for child in writers]
        succeeded |= _merged(entry, effects, sites)
    failed = _merged(entry, [_ended(child, ways, None) for child in writers], sites)
    return {"success": succeeded, "failure": failed}


def _writers(children: Sequence[Placed], ways: Ways) -> list[Placed]:
    return [child for child in children if any(way.effect.keys for way in ways[child.path])]


def _ended(child: Placed, ways: Ways, label: str | None) -> Effect:
    """Return the effect of a child that has ended so; of one that may be stopped anywhere without a label."""
    ended = [way.effect for way in ways[child.path] if way.label == label]
    if ended:
        return either(ended)
    return either(way.effect.perhaps() for way in ways[child.path])


def _merged(entry: int, effects: Iterable[Effect], sites: Sites) -> int:
    fact = entry
    for effect in effects:
        fact = effect.after(fact, sites) if effect is not NOTHING else fact
    return fact
