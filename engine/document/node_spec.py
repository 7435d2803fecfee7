"""The nodes of a behavior document as frozen models: states, containers and the parts of trees.

A node has exactly one kind key and, beside it, keys that hold for every kind (`transitions`,
`timeout`, `retry`, `on_error`, `guard`, `autonomy`, `resume`, `description`). Mappings keep the
order of the document, which is the order of precedence.
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
    """Preempt the node `after` a duration and leave it for `to`.

    In a machine `to` is a sibling or an outcome of the machine; in a concurrency or foreach
    container it is the outcome that the container sees; in a tree it is `success` or `failure`; at
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
    """Run the node again, up to `times` more, after these outcomes, and after errors when `errors`.

    The wait before the first repetition is `backoff`; it doubles each time. As a decorator in a
    tree it has a `child` and runs it again after FAILURE.
    """

    times: Annotated[int, Meta(ge=1, le=1_000_000, description="How often to run it again, 1 or more")]
    backoff: Duration = 0.0
    outcomes: tuple[str, ...] = ()
    errors: bool = True
    child: NodeSpec | None = None

    @property
    def backoff_s(self) -> float:
        """The first wait in seconds."""
        return seconds(self.backoff)


class GuardSpec(StrictModel, frozen=True, kw_only=True):
    """Enter the node only when the expression `when` is true, else leave it at once for `to`.

    In a tree `to` is `success`, `failure` or `skipped`. As a decorator there it has a `child`, which is stopped when
    `when` becomes false; without `to` it then fails.
    """

    when: Expression
    to: str | None = None
    child: NodeSpec | None = None


class MachineSpec(StrictModel, frozen=True, kw_only=True):
    """A state machine: one child at a time, from `initial` along the children's `transitions`."""

    initial: str
    states: Annotated[dict[NodeName, NodeSpec], Meta(min_length=1, description="The children, at least one")]
    userdata: dict[Key, object] = {}


class ConcurrencySpec(StrictModel, frozen=True, kw_only=True):
    """Children side by side; the first condition that holds decides the outcome.

    A condition asks for outcomes of children, all of them, or any `at_least` of them. One with `preempt` decides
    nothing: when it first holds, the children named there are preempted and the others go on. Keys in `shared` have one
    value for all children at any time; what a child writes to other keys is seen by the others once all have ended.
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

    Outcomes: `exhausted` when all were done, `broken` when a child ended otherwise than `next` says.

    `items` is an expression that gives a list. Each round has a scope of its own with the item
    under the key `as` and the number of the round, from 0, under `index`. `next` names the
    outcomes after which the next round begins, by default those that mean success to the child.
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
    """Children of a sequence or selector; with `memory` a child that is done is not asked again.

    A plain list of children has memory.
    """

    children: Annotated[tuple[NodeSpec, ...], Meta(min_length=1, description="The children, at least one")]
    memory: bool


class ParallelSpec(StrictModel, frozen=True, kw_only=True):
    """Children ticked together; `policy` says whose success is its own: `all`, `one`, or those named.

    With `synchronise` a child that has succeeded is not run again while the others are at work.

    With thresholds in place of a policy it succeeds when `success_count` children have (all, without it) and fails when
    `failure_count` have failed (1, without it) or too few are left to succeed; a child that has ended is not run again.
    """

    children: Annotated[tuple[NodeSpec, ...], Meta(min_length=1, description="The children, at least one")]
    policy: Literal["all", "one"] | Annotated[tuple[str, ...], Meta(min_length=1)] = "all"
    synchronise: bool = True
    success_count: Annotated[int, Meta(ge=1, description="How many children must succeed")] | None = None
    failure_count: Annotated[int, Meta(ge=1, description="How many children must fail")] | None = None

    @property
    def counts(self) -> bool:
        """Whether it has thresholds in place of a policy."""
        return self.success_count is not None or self.failure_count is not None


class DecoratorSpec(StrictModel, frozen=True, kw_only=True):
    """Turns SUCCESS of its child into FAILURE and back."""

    child: NodeSpec


class OneShotSpec(StrictModel, frozen=True, kw_only=True):
    """Runs its child to completion, or to success, once in a run of the tree, and remembers the end."""

    child: NodeSpec
    policy: Literal["completion", "success"] = "completion"


class RepeatSpec(StrictModel, frozen=True, kw_only=True):
    """Runs its child until it has succeeded `times` times in a row; fails when it fails."""

    child: NodeSpec
    times: Times


class CooldownSpec(StrictModel, frozen=True, kw_only=True):
    """Fails without asking its child until `after` has passed since the child last ended."""

    child: NodeSpec
    after: Duration

    @property
    def after_s(self) -> float:
        """The duration in seconds."""
        return seconds(self.after)


class RemapSpec(StrictModel, frozen=True, kw_only=True):
    """Shows another status than the child has.

    Where an end of the child is shown as `running`, the child is run again `every` so often.
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
    """Is SUCCESS when the child has this status, RUNNING until then.

    A child that has ended otherwise is run again `every` so often.
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
    """Asks `if` once; then runs `then` where that has succeeded, else `else`, and ends as that does.

    Without `else` it fails where `if` has failed.
    """

    condition: NodeSpec
    body: NodeSpec
    otherwise: NodeSpec | None = None


class WhileDoElseSpec(
    StrictModel, frozen=True, kw_only=True, rename={"condition": "while", "body": "do", "otherwise": "else"}
):
    """Runs `do` while `while` succeeds, `else` while it fails, and ends as that does; without `else` it fails.

    `while` is asked again in the meantime as checks are in a composite without memory. When it says something else,
    what runs is halted and its clean-up awaited before the other begins.
    """

    condition: NodeSpec
    body: NodeSpec
    otherwise: NodeSpec | None = None


TREE_OUTCOMES = ("success", "failure")
GUARD_TARGETS = (*TREE_OUTCOMES, "skipped")
"""Where a guard may lead in a tree; what is skipped is passed over by the part around it."""
FOREACH_OUTCOMES = ("exhausted", "broken")

_Listed = Annotated[tuple["NodeSpec", ...], Meta(min_length=1, description="The children, at least one")]


class NodeSpec(
    StrictModel, frozen=True, kw_only=True, dict=True, rename={"parameters": "with", "inputs": "in", "outputs": "out"}
):
    """One node: its kind, its wiring into the enclosing container, and what to do when it fails.

    `parameters` (`with:`) go to a state or behavior; text in them may hold `${…}` expressions.
    `inputs` (`in:`) maps input keys of the state or behavior to userdata keys that can be read
    here, `outputs` (`out:`) maps output keys to the userdata keys that they are written to.
    `autonomy` names for an outcome the level from which on it does not pass by itself any more;
    `resume` says what to do with the node after a crash: `rerun`, `ask`, or take an outcome.
    `success` (in a tree) names the outcomes that mean SUCCESS; `name` (in a tree) is its place in paths.
    `post` (in a tree) says which userdata is assigned when it has ended, or was halted.
    `every` (in a tree) is how often a py_trees `behaviour` is ticked while it is RUNNING, 0.1 s without it,
    and how often a check is asked again while it stands in front of a running action in a composite without memory.
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
        """All kind keys it has; a valid node has one."""
        plain: tuple[NodeKind, ...] = tuple(kind for kind in (*KINDS, *TREE_KINDS) if getattr(self, kind) is not None)
        wrapping: tuple[NodeKind, ...] = tuple(key for key in WRAPPERS if self._wrapped(key) is not None)
        return (*plain, *wrapping)

    @property
    def kind(self) -> NodeKind:
        """The key that says what the node is."""
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
        """Its name inside a tree: as given, else after what it is."""
        if self.name is not None:
            return self.name
        said = self.state or self.behaviour or ""
        said = re.split(r"[.:]", said)[-1] or (PurePosixPath(self.behavior).stem if self.behavior else "")
        return re.sub(r"[^A-Za-z0-9_-]", "_", said)[:64] or (self.kinds or ("node",))[0]


def shared_keys(node: NodeSpec) -> tuple[str, ...]:
    """Return the keys that the branches of a concurrency container share; of another node none."""
    return node.concurrency.shared if node.concurrency is not None else ()


def _names(children: Iterable[NodeSpec]) -> list[str]:
    return numbered(child.own_name for child in children)
