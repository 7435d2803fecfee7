"""The nodes of a behavior document as frozen models: states, containers and the parts of trees.

A node has exactly one kind key and optional keys that apply to every kind (`transitions`,
`timeout`, `retry`, `on_error`, `guard`, `autonomy`, `resume`, `description`). Mappings keep the
order of the document, the order of precedence.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping
from functools import cached_property
from pathlib import PurePosixPath
from typing import Annotated, Literal

from msgspec import Meta

from engine.document.concurrency_condition import ConcurrencyCondition, ConditionEntry, read_entry
from engine.document.decoding import StrictModel
from engine.document.duration import Duration, seconds
from engine.document.node_kind import (
    KINDS,
    SLOTS,
    TREE_KINDS,
    WRAPPERS,
    AutonomyLevel,
    Expression,
    Key,
    NodeKind,
    NodeName,
    PostConditionsSpec,
    Reference,
    Status,
    Times,
    Wrapper,
    numbered,
)


class TimeoutSpec(StrictModel, frozen=True, kw_only=True):
    """Preempt the node `after` a duration and continue at `to`.

    In a machine `to` is a sibling or an outcome of the machine; in a concurrency or foreach
    container it is the outcome of the node for the container; in a tree it is `success` or `failure`; at
    the root it is an outcome of the behavior. As a decorator in a tree it has a `child` and fails.
    """

    after: Duration
    to: str | None = None
    child: NodeSpec | None = None

    @property
    def after_s(self) -> float:
        """The duration in seconds."""
        return seconds(self.after)


class RetrySpec(StrictModel, frozen=True, kw_only=True):
    """Retry the node, up to `times` times, after these outcomes, and after errors with `errors`.

    The wait before the first retry is `backoff`; it doubles each time. As a decorator in a
    tree it has a `child` and retries it after FAILURE.
    """

    times: Annotated[int, Meta(ge=1, le=1_000_000, description="Maximum number of retries, 1 or more")]
    backoff: Duration = 0.0
    outcomes: tuple[str, ...] = ()
    errors: bool = True
    child: NodeSpec | None = None

    @property
    def backoff_s(self) -> float:
        """The first wait in seconds."""
        return seconds(self.backoff)


class GuardSpec(StrictModel, frozen=True, kw_only=True):
    """Enter the node only if the expression `when` is true, else continue at `to`.

    In a tree `to` is `success`, `failure` or `skipped`. As a decorator there it has a `child`, which is halted when
    `when` becomes false; without `to` it then fails.
    """

    when: Expression
    to: str | None = None
    child: NodeSpec | None = None


class MachineSpec(StrictModel, frozen=True, kw_only=True):
    """A state machine: runs one child at a time, from `initial` along the children's `transitions`."""

    initial: str
    states: Annotated[dict[NodeName, NodeSpec], Meta(min_length=1, description="The children, at least one")]
    userdata: dict[Key, object] = {}


class ConcurrencySpec(StrictModel, frozen=True, kw_only=True):
    """Concurrent children; the first condition that holds decides the outcome.

    A condition requires outcomes of children: all of them, or any `at_least` of them. One with `preempt` decides
    no outcome: when it first holds, the children named there are preempted and the others continue. Keys in `shared`
    have one value for all children at any time; other keys written by a child become visible to the others when all
    have ended.
    """

    states: Annotated[dict[NodeName, NodeSpec], Meta(min_length=1, description="The children, at least one")]
    conditions: tuple[ConditionEntry, ...]
    otherwise: str | None = None
    userdata: dict[Key, object] = {}
    shared: tuple[Key, ...] = ()

    @property
    def rules(self) -> tuple[ConcurrencyCondition, ...]:
        """The conditions in order of precedence, those that preempt among them."""
        return tuple(rule for entry in self.conditions if (rule := read_entry(entry)) is not None)


class ForEachSpec(StrictModel, frozen=True, kw_only=True, rename={"item": "as"}):
    """Run `child` once for each of `items`, or `times` times.

    Outcomes: `exhausted` after all rounds, `broken` when a child ended with an outcome not in `next`.

    `items` is an expression whose value is a list. Each round has its own scope with the item
    under the key `as` and the number of the round, from 0, under `index`. `next` names the
    outcomes after which the next round begins, by default the success outcomes of the child.
    `collect` appends, after each such round, the value of a key to a list outside.
    """

    child: NodeSpec
    items: Expression | list[object] | None = None
    times: int | float | Expression | None = None
    item: Key = "item"
    index: Key | None = None
    next: tuple[str, ...] = ()
    collect: dict[Key, Key] = {}
    userdata: dict[Key, object] = {}


class CompositeSpec(StrictModel, frozen=True, kw_only=True):
    """Children of a sequence or selector; with `memory` a completed child is not ticked again.

    A plain list of children has memory.
    """

    children: Annotated[tuple[NodeSpec, ...], Meta(min_length=1, description="The children, at least one")]
    memory: bool


class ParallelSpec(StrictModel, frozen=True, kw_only=True):
    """Children ticked together; `policy` names the children that must succeed: `all`, `one`, or names.

    With `synchronise` a child that has succeeded is not restarted while the others run.

    With thresholds instead of a policy it succeeds when `success_count` children have succeeded (default: all) and
    fails when `failure_count` have failed (default: 1) or success is impossible; ended children are not restarted.
    """

    children: Annotated[tuple[NodeSpec, ...], Meta(min_length=1, description="The children, at least one")]
    policy: Literal["all", "one"] | Annotated[tuple[str, ...], Meta(min_length=1)] = "all"
    synchronise: bool = True
    success_count: Annotated[int, Meta(ge=1, description="Number of children that must succeed")] | None = None
    failure_count: Annotated[int, Meta(ge=1, description="Number of children that must fail")] | None = None

    @property
    def counts(self) -> bool:
        """Whether it has thresholds instead of a policy."""
        return self.success_count is not None or self.failure_count is not None


class DecoratorSpec(StrictModel, frozen=True, kw_only=True):
    """Turns SUCCESS of its child into FAILURE and back."""

    child: NodeSpec


class OneShotSpec(StrictModel, frozen=True, kw_only=True):
    """Runs its child to completion, or to success, once in a run of the tree, and keeps the status."""

    child: NodeSpec
    policy: Literal["completion", "success"] = "completion"


class RepeatSpec(StrictModel, frozen=True, kw_only=True):
    """Runs its child until it has succeeded `times` times in a row; fails when the child fails."""

    child: NodeSpec
    times: Times


class CooldownSpec(StrictModel, frozen=True, kw_only=True):
    """Fails without ticking its child until `after` has passed since the child last ended."""

    child: NodeSpec
    after: Duration

    @property
    def after_s(self) -> float:
        """The duration in seconds."""
        return seconds(self.after)


class RemapSpec(StrictModel, frozen=True, kw_only=True):
    """Maps the status of its child to another status.

    If a final status is mapped to `running`, the child is restarted with the period `every`.
    """

    child: NodeSpec
    success: Status = "success"
    failure: Status = "failure"
    running: Status = "running"
    every: Duration = 0.1

    @property
    def every_s(self) -> float:
        """The period in seconds."""
        return seconds(self.every)


class StatusConditionSpec(StrictModel, frozen=True, kw_only=True):
    """SUCCESS when the child has this status, RUNNING until then.

    A child that has ended with another status is restarted with the period `every`.
    """

    child: NodeSpec
    status: Status
    every: Duration = 0.1

    @property
    def every_s(self) -> float:
        """The period in seconds."""
        return seconds(self.every)


class IfThenElseSpec(
    StrictModel, frozen=True, kw_only=True, rename={"condition": "if", "body": "then", "otherwise": "else"}
):
    """Ticks `if` to its end once, then runs `then` after success or `else` after failure, with its status.

    Without `else` it fails if `if` has failed.
    """

    condition: NodeSpec
    body: NodeSpec
    otherwise: NodeSpec | None = None


class WhileDoElseSpec(
    StrictModel, frozen=True, kw_only=True, rename={"condition": "while", "body": "do", "otherwise": "else"}
):
    """Runs `do` while `while` succeeds, `else` while it fails, with its status; without `else` it fails.

    `while` is repeated in the meantime like a check in a composite without memory. When its status changes, the
    active branch is halted and its clean-up awaited before the other branch starts.
    """

    condition: NodeSpec
    body: NodeSpec
    otherwise: NodeSpec | None = None


TREE_OUTCOMES = ("success", "failure")
GUARD_TARGETS = (*TREE_OUTCOMES, "skipped")
"""The targets of a guard in a tree; the parent passes over a skipped node."""
FOREACH_OUTCOMES = ("exhausted", "broken")

_Listed = Annotated[tuple["NodeSpec", ...], Meta(min_length=1, description="The children, at least one")]


class NodeSpec(
    StrictModel, frozen=True, kw_only=True, dict=True, rename={"parameters": "with", "inputs": "in", "outputs": "out"}
):
    """One node: its kind, its connections in the container, and its error handling.

    `parameters` (`with:`) are passed to a state or behavior; text in them may contain `${…}` expressions.
    `inputs` (`in:`) maps input keys of the state or behavior to userdata keys that can be read
    here, `outputs` (`out:`) maps output keys to the userdata keys that they are written to.
    `autonomy` sets for an outcome the level up to which it waits for the operator;
    `resume` defines how the node is resumed after a crash: `rerun`, `ask`, or an outcome.
    `success` (in a tree) names the outcomes that mean SUCCESS; `name` (in a tree) is its name in paths.
    `post` (in a tree) defines the userdata assigned when it has ended or was halted.
    `every` (in a tree) is the tick period of a py_trees `behaviour` while it is RUNNING, default 0.1 s, and the
    period at which a check is repeated before a running action in a composite without memory.
    """

    state: str | None = None
    machine: MachineSpec | None = None
    concurrency: ConcurrencySpec | None = None
    priority: MachineSpec | None = None
    tree: NodeSpec | None = None
    foreach: ForEachSpec | None = None
    behavior: Reference | None = None
    sequence: _Listed | CompositeSpec | None = None
    selector: _Listed | CompositeSpec | None = None
    parallel: _Listed | ParallelSpec | None = None
    inverter: DecoratorSpec | None = None
    one_shot: OneShotSpec | None = None
    repeat: RepeatSpec | None = None
    cooldown: CooldownSpec | None = None
    remap: RemapSpec | None = None
    condition: StatusConditionSpec | None = None
    if_then_else: IfThenElseSpec | None = None
    while_do_else: WhileDoElseSpec | None = None
    behaviour: str | None = None
    every: Duration | None = None
    name: NodeName | None = None
    parameters: dict[str, object] = {}
    inputs: dict[str, Key] = {}
    outputs: dict[str, Key] = {}
    transitions: dict[str, str] = {}
    guard: GuardSpec | None = None
    post: PostConditionsSpec | None = None
    timeout: TimeoutSpec | None = None
    retry: RetrySpec | None = None
    on_error: str | None = None
    autonomy: dict[str, AutonomyLevel] = {}
    resume: str | None = None
    success: tuple[str, ...] = ()
    description: str = ""

    @property
    def kinds(self) -> tuple[NodeKind, ...]:
        """All kind keys of the node; a valid node has one."""
        plain: tuple[NodeKind, ...] = tuple(kind for kind in (*KINDS, *TREE_KINDS) if getattr(self, kind) is not None)
        wrapping: tuple[NodeKind, ...] = tuple(key for key in WRAPPERS if self._wrapped(key) is not None)
        return (*plain, *wrapping)

    @property
    def kind(self) -> NodeKind:
        """The kind key of the node."""
        if self.state is not None:
            return "state"
        return self.kinds[0]

    @property
    def sequential(self) -> MachineSpec | None:
        """The states and the initial one of a machine or priority container."""
        return self.machine or self.priority

    @property
    def children(self) -> Mapping[str, NodeSpec]:
        """The nodes directly inside, by the last part of their path, in document order."""
        if self.state is not None:
            return {}
        container = self.machine or self.concurrency or self.priority
        if container is not None:
            return container.states
        return self._inside

    def child_keys(self, name: str) -> tuple[str | int, ...]:
        """Return the keys, from this node inward, under which the child `name` is written."""
        if self.machine is not None or self.concurrency is not None or self.priority is not None:
            return (self.kind, "states", name)
        return self._keys_inside[name]

    @property
    def userdata(self) -> Mapping[str, object]:
        """The initial values of the container's own scope."""
        container = self.machine or self.concurrency or self.priority or self.foreach
        return container.userdata if container is not None else {}

    @cached_property
    def _inside(self) -> Mapping[str, NodeSpec]:
        return {name: child for name, _, child in self._placed()}

    @cached_property
    def _keys_inside(self) -> Mapping[str, tuple[str | int, ...]]:
        return {name: keys for name, keys, _ in self._placed()}

    def _wrapped(self, key: Wrapper) -> NodeSpec | None:
        wrapper: RetrySpec | TimeoutSpec | GuardSpec | None = getattr(self, key)
        return wrapper.child if wrapper is not None else None

    def _placed(self) -> list[tuple[str, tuple[str | int, ...], NodeSpec]]:
        if self.foreach is not None:
            return [("child", ("foreach", "child"), self.foreach.child)]
        if self.tree is not None:
            return [(self.tree.own_name, ("tree",), self.tree)]
        for kind, group in (("sequence", self.sequence), ("selector", self.selector), ("parallel", self.parallel)):
            if isinstance(group, tuple):
                return [(n, (kind, i), c) for i, (n, c) in enumerate(zip(_names(group), group, strict=True))]
            if group is not None:
                named = zip(_names(group.children), group.children, strict=True)
                return [(n, (kind, "children", i), c) for i, (n, c) in enumerate(named)]
        branching = self.if_then_else or self.while_do_else
        if branching is not None:
            roles = zip(SLOTS[self.kind], (branching.condition, branching.body, branching.otherwise), strict=True)
            filled = [(key, child) for key, child in roles if child is not None]
            return [(n, (self.kind, k), c) for n, (k, c) in zip(_names(c for _, c in filled), filled, strict=True)]
        single = self.inverter or self.one_shot or self.repeat or self.cooldown or self.remap or self.condition
        if single is not None:
            return [(single.child.own_name, (self.kind, "child"), single.child)]
        for key in WRAPPERS:
            child = self._wrapped(key)
            if child is not None:
                return [(child.own_name, (key, "child"), child)]
        return []

    @property
    def own_name(self) -> str:
        """Its name inside a tree: as written, else derived from its kind."""
        if self.name is not None:
            return self.name
        kind = self.state or self.behaviour or ""
        kind = re.split(r"[.:]", kind)[-1] or (PurePosixPath(self.behavior).stem if self.behavior else "")
        return re.sub(r"[^A-Za-z0-9_-]", "_", kind)[:64] or (self.kinds or ("node",))[0]


def shared_keys(node: NodeSpec) -> tuple[str, ...]:
    """Return the keys that the branches of a concurrency container share; empty for other nodes."""
    return node.concurrency.shared if node.concurrency is not None else ()


def _names(children: Iterable[NodeSpec]) -> list[str]:
    return numbered(child.own_name for child in children)
