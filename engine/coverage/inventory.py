"""All items that runs of a behavior can cover: its nodes and their exits, with their positions."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from functools import cached_property

from engine.coverage.coverage_item import CoverageItem, ItemKind
from engine.document.behavior import Behavior
from engine.document.nodes.concurrency_condition import ConcurrencyCondition
from engine.document.nodes.node_kind import WRAPPERS, TreeStatus
from engine.document.nodes.node_spec import TREE_KINDS, TREE_OUTCOMES, NodeSpec
from engine.errors import Position
from engine.runtime.plan import Catalogue, Plan, new_plan


@dataclass(frozen=True, kw_only=True)
class ConditionItem:
    """One condition of a concurrency container, or its `otherwise`, under the name of its item."""

    name: str
    condition: ConcurrencyCondition


@dataclass(frozen=True, kw_only=True)
class CoverageInventory:
    """The items that can be covered in a behavior and in those that it references."""

    behavior: Behavior
    items: tuple[CoverageItem, ...]
    roots: frozenset[str]
    """The paths of the roots of behaviors."""
    rules: Mapping[str, tuple[ConditionItem, ...]]
    """The conditions of each concurrency container, by path."""
    succeeding: Mapping[str, frozenset[str]]
    """The outcomes that map to SUCCESS, by path of each leaf of a tree."""

    @cached_property
    def behaviors(self) -> tuple[Behavior, ...]:
        """The behavior and every behavior that it references, each file once."""
        found: dict[str, Behavior] = {}
        due = [self.behavior]
        while due:
            behavior = due.pop()
            if str(behavior.file) not in found:
                found[str(behavior.file)] = behavior
                due += reversed(list(behavior.references.values()))
        return tuple(found.values())


def take_inventory(behavior: Behavior, catalogue: Catalogue) -> CoverageInventory:
    """Return the items that runs of a behavior can cover, in document order.

    Raises:
        DocumentError: the behavior is invalid.
    """
    plan = new_plan(behavior, catalogue)
    listing = _Listing(plan)
    listing.add(behavior, "root")
    return CoverageInventory(
        behavior=behavior,
        items=tuple(listing.items),
        roots=frozenset(listing.roots),
        rules=listing.rules,
        succeeding=listing.succeeding,
    )


class _Listing:
    def __init__(self, plan: Plan) -> None:
        self._plan = plan
        self.items: list[CoverageItem] = []
        self.roots: list[str] = []
        self.rules: dict[str, tuple[ConditionItem, ...]] = {}
        self.succeeding: dict[str, frozenset[str]] = {}

    def add(self, behavior: Behavior, base: str) -> None:
        """Add the nodes of a behavior whose root has the path `base`."""
        self.roots.append(base)
        nodes = dict(behavior.nodes())
        in_tree: dict[str, bool] = {"": False}
        passed_over: set[str] = set()
        for inside, node in nodes.items():
            above = inside.rpartition("/")[0]
            if node.is_disabled or above in passed_over:
                passed_over.add(inside)
                continue
            path = base + inside.removeprefix("root")
            self._add("node", path, behavior.position(inside))
            if in_tree[above]:
                self._add_statuses(behavior, inside, path, node)
            elif not above:
                self._add_outcomes_of_behavior(behavior, path)
            elif nodes[above].sequential is not None:
                self._add_transitions(behavior, inside, path, node)
            else:
                self._add_outcomes(behavior, inside, path)
            self._add_conditions(behavior, inside, path, node)
            self._add_diversions(behavior, inside, path, node)
            in_tree[inside] = node.tree is not None or (in_tree[above] and _is_part(node))
            if node.behavior is not None:
                self.add(behavior.references[node.behavior], f"{path}/root")

    def _add(self, kind: ItemKind, path: str, place: Position, name: str = "", target: str = "") -> None:
        self.items.append(
            CoverageItem(
                kind=kind,
                path=path,
                name=name,
                target=target,
                file=place.file,
                line=place.line,
                column=place.column,
            )
        )

    def _add_outcomes_of_behavior(self, behavior: Behavior, path: str) -> None:
        for index, outcome in enumerate(behavior.outcomes):
            self._add("outcome", path, behavior.source.position(("outcomes", index)), outcome)

    def _add_outcomes(self, behavior: Behavior, inside: str, path: str) -> None:
        for outcome in self._plan.outcomes_of(path) or ():
            self._add("outcome", path, behavior.position(inside), outcome)

    def _add_transitions(self, behavior: Behavior, inside: str, path: str, node: NodeSpec) -> None:
        for outcome, target in node.transitions.items():
            self._add("transition", path, behavior.key_position(inside, "transitions", outcome), outcome, target)
        for outcome in self._plan.outcomes_of(path) or ():
            if outcome not in node.transitions:
                self._add("outcome", path, behavior.position(inside), outcome)

    def _add_statuses(self, behavior: Behavior, inside: str, path: str, node: NodeSpec) -> None:
        planned = self._plan.nodes.get(path)
        statuses: Iterable[str] = _statuses_of_part(node)
        if planned is not None and not _is_part(node):
            succeeding = frozenset(node.success) or planned.work.nominal
            self.succeeding[path] = succeeding
            statuses = {"success" if outcome in succeeding else "failure" for outcome in planned.work.outcomes}
        for status in TREE_OUTCOMES:
            if status in statuses:
                self._add("status", path, behavior.position(inside), status)

    def _add_conditions(self, behavior: Behavior, inside: str, path: str, node: NodeSpec) -> None:
        container = node.concurrency
        if container is None:
            return
        rules: list[ConditionItem] = []
        for number, rule in enumerate(container.rules, start=1):
            rules.append(ConditionItem(name=f"{number}: {_text(rule)}", condition=rule))
            where = behavior.position(inside, "concurrency", "conditions", number - 1)
            self._add("condition", path, where, rules[-1].name, rule.consequence)
        if container.otherwise is not None:
            always = ConcurrencyCondition(outcome=container.otherwise, when={})
            rules.append(ConditionItem(name="otherwise", condition=always))
            where = behavior.key_position(inside, "concurrency", "otherwise")
            self._add("condition", path, where, "otherwise", container.otherwise)
        self.rules[path] = tuple(rules)

    def _add_diversions(self, behavior: Behavior, inside: str, path: str, node: NodeSpec) -> None:
        if node.guard is not None and node.guard.to is not None:
            self._add("guard", path, behavior.key_position(inside, "guard"), target=node.guard.to)
        if node.timeout is not None and node.timeout.to is not None:
            self._add("timeout", path, behavior.key_position(inside, "timeout"), target=node.timeout.to)
        if node.on_error is not None:
            self._add("on_error", path, behavior.key_position(inside, "on_error"), target=node.on_error)


def _is_part(node: NodeSpec) -> bool:
    """Whether a node of a tree is a composite, decorator or foreign behaviour, and not a native leaf."""
    return node.kind in (*TREE_KINDS, *WRAPPERS)


def _statuses_of_part(node: NodeSpec) -> tuple[str, ...]:
    """Return the statuses that a tree node may show, where its children may end with both."""
    decorator = node.decorator
    if decorator is None:
        return TREE_OUTCOMES
    below: tuple[TreeStatus, ...] = ("success", "failure", "running")
    return tuple(shown for status in below for shown in decorator.statuses(status))


def _text(rule: ConcurrencyCondition) -> str:
    children = ", ".join(f"{child}: {outcome}" for child, outcome in rule.when.items())
    return f"{rule.consequence} ← {children if rule.needs_all else f'{rule.needed} of {children}'}"
