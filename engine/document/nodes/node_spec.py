"""The nodes of a behavior document as frozen models: states, containers and the parts of trees.

A node has exactly one kind key and optional keys that apply to every kind (`transitions`,
`timeout`, `retry`, `on_error`, `guard`, `autonomy`, `resume`, `description`). Mappings keep the
order of the document, the order of precedence.

The class of a decorator says everything that check, editor and page know of it; `node_kinds.py` says it of the others.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Annotated, ClassVar, Literal, cast

from msgspec import Meta

from engine.document.duration import Duration, seconds
from engine.document.nodes.concurrency_condition import ConcurrencyCondition, ConditionEntry, read_entry
from engine.document.nodes.decorator_spec import MAY_FAIL, DecoratorSpec, Turns
from engine.document.nodes.node_kind import (
    KINDS,
    AutonomyLevel,
    Expression,
    FormField,
    Key,
    NodeName,
    OutcomeName,
    PostConditionsSpec,
    Reference,
    Status,
    Times,
    TreeStatus,
    derived_name,
)
from engine.document.nodes.node_shape import NodeShape, kind_keys
from engine.document.nodes.tree_composites import CompositeSpec, IfThenElseSpec, ParallelSpec, WhileDoElseSpec
from engine.document.text.decoding import StrictModel


class TimeoutSpec(DecoratorSpec, frozen=True, kw_only=True):
    """Preempt the node `after` a duration and continue at `to`.

    In a machine `to` is a sibling or an outcome of the machine; in a concurrency or foreach
    container it is the outcome of the node for the container; in a tree it is `success` or `failure`; at
    the root it is an outcome of the behavior. As a decorator in a tree it has a `child` and fails.
    """

    icon = "clock"
    doc = "Fails when its child takes too long."
    turns = MAY_FAIL

    after: Annotated[Duration, FormField("After", "Such as 30 s", "10 s")]
    to: str | None = None
    child: NodeSpec | None = None

    @property
    def after_s(self) -> float:
        """The duration in seconds."""
        return seconds(self.after)


class RetrySpec(DecoratorSpec, frozen=True, kw_only=True):
    """Retry the node, up to `times` times, after these outcomes, and after errors with `errors`.

    The wait before the first retry is `backoff`; it doubles each time. As a decorator in a
    tree it has a `child` and retries it after FAILURE.
    """

    icon = "refresh"
    doc = "Executes its child again after a failure."
    turns: ClassVar[Turns] = {"failure": ("running", "failure")}

    times: Annotated[
        int,
        Meta(ge=1, le=1_000_000, description="Maximum number of retries, 1 or more"),
        FormField("Times", "How often it is run again after failure", 1),
    ]
    backoff: Annotated[Duration, FormField("Wait first", "Such as 2 s")] = 0.0
    outcomes: tuple[str, ...] = ()
    errors: bool = True
    child: NodeSpec | None = None

    @property
    def backoff_s(self) -> float:
        """The first wait in seconds."""
        return seconds(self.backoff)

    @property
    def late(self) -> frozenset[TreeStatus]:
        """It fails after its last run, and waits before each but the first."""
        return frozenset({"failure"} if self.backoff_s > 0 else ())


class GuardSpec(DecoratorSpec, frozen=True, kw_only=True):
    """Enter the node only if the expression `when` is true, else continue at `to`.

    In a tree `to` is `success`, `failure` or `skipped`. As a decorator there it has a `child`, which is halted when
    `when` becomes false; without `to` it then fails.
    """

    icon = "shield"
    doc = "Executes its child only while an expression is true; otherwise fails or is skipped."

    when: Annotated[Expression, FormField("While", "An expression, ${…}", "${true}")]
    to: Annotated[str | None, FormField("Else", "failure, success or skipped; failure without")] = None
    child: NodeSpec | None = None

    def statuses(self, child: TreeStatus) -> tuple[TreeStatus, ...]:
        """Return that of the child, and that of a guard whose expression is false."""
        return (child, cast("TreeStatus", self.to or "failure"))


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
    shared: Annotated[
        tuple[Key, ...], FormField("Shared keys", "Names as a list: branches see each other write them")
    ] = ()

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
    items: Annotated[Expression | list[object] | None, FormField("Items", "A list, or ${…} that gives one")] = None
    times: Annotated[int | float | Expression | None, FormField("Times", "Rounds, instead of items")] = None
    item: Annotated[Key, FormField("Item is called", "Key of the item in each round, `item` without")] = "item"
    index: Annotated[Key | None, FormField("Number is called", "Key of the number of the round")] = None
    next: tuple[str, ...] = ()
    collect: dict[Key, Key] = {}
    userdata: dict[Key, object] = {}


class InverterSpec(DecoratorSpec, frozen=True, kw_only=True):
    """Turns SUCCESS of its child into FAILURE and back."""

    icon = "switch"
    doc = "Inverts success and failure of its child."
    turns: ClassVar[Turns] = {"success": ("failure",), "failure": ("success",)}

    child: NodeSpec


class OneShotSpec(DecoratorSpec, frozen=True, kw_only=True):
    """Runs its child to completion, or to success, once in a run of the tree, and keeps the status."""

    icon = "once"
    doc = "Executes its child once and keeps its final status."

    child: NodeSpec
    policy: Annotated[Literal["completion", "success"], FormField("Once", "`completion` or `success`")] = "completion"


class RepeatSpec(DecoratorSpec, frozen=True, kw_only=True):
    """Runs its child until it has succeeded `times` times in a row; fails when the child fails."""

    icon = "loop"
    doc = "Executes its child until it has succeeded a number of times in a row."
    turns: ClassVar[Turns] = {"success": ("running", "success")}

    child: NodeSpec
    times: Annotated[Times, FormField("Times", "Successes in a row", 2)]


class CooldownSpec(DecoratorSpec, frozen=True, kw_only=True):
    """Fails without ticking its child until `after` has passed since the child last ended."""

    icon = "hourglass"
    doc = "Fails without ticking its child until a time has passed since the child ended."
    turns = MAY_FAIL

    child: NodeSpec
    after: Annotated[Duration, FormField("After", "Such as 30 s", "1 s")]


class RemapSpec(DecoratorSpec, frozen=True, kw_only=True):
    """Maps the status of its child to another status.

    If a final status is mapped to `running`, the child is restarted with the period `every`.
    """

    icon = "exchange"
    doc = "Maps the status of its child to another status."

    child: NodeSpec
    success: Status = "success"
    failure: Status = "failure"
    running: Status = "running"
    every: Duration = 0.1

    def statuses(self, child: TreeStatus) -> tuple[TreeStatus, ...]:
        """Return that to which the status is mapped, after an end also that shown while the child was RUNNING."""
        if child == "skipped":
            return (child,)
        mapped: Mapping[TreeStatus, Status] = {"success": self.success, "failure": self.failure}
        shown = {self.running, mapped.get(child, self.running)}
        order: tuple[Status, ...] = ("running", "failure", "success")
        return tuple(status for status in order if status in shown)


class StatusConditionSpec(DecoratorSpec, frozen=True, kw_only=True):
    """SUCCESS when the child has this status, RUNNING until then.

    A child that has ended with another status is restarted with the period `every`.
    """

    icon = "filter"
    doc = "Succeeds when its child has a given status, and is running until then."

    child: NodeSpec
    status: Annotated[Status, FormField(new="success")]
    every: Duration = 0.1

    def statuses(self, child: TreeStatus) -> tuple[TreeStatus, ...]:
        """Return SUCCESS if the status may have been reached, and RUNNING."""
        if child == "skipped":
            return (child,)
        return ("success", "running") if self.status in (child, "running") else ("running",)

    def why_endless(self, ends: str) -> str:
        """Return the status that it waits for."""
        return f"waits for {self.status}, but its child only ends with {ends}"


TREE_OUTCOMES = ("success", "failure")
GUARD_TARGETS = (*TREE_OUTCOMES, "skipped")
"""The targets of a guard in a tree; the parent passes over a skipped node."""
FOREACH_OUTCOMES = ("exhausted", "broken")

_Listed = Annotated[tuple["NodeSpec", ...], Meta(min_length=1, description="The children, at least one")]


class NodeSpec(
    NodeShape, frozen=True, kw_only=True, dict=True, rename={"parameters": "with", "inputs": "in", "outputs": "out"}
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
    `disabled` passes the node over: outside trees it names the outcome with which the node counts as ended, in a tree
    it is `true`, and the parent goes on as after a skipped child.
    """

    state: str | None = None
    machine: MachineSpec | None = None
    concurrency: ConcurrencySpec | None = None
    priority: MachineSpec | None = None
    tree: NodeSpec | None = None
    foreach: ForEachSpec | None = None
    behavior: Reference | None = None
    sequence: _Listed | CompositeSpec[NodeSpec] | None = None
    selector: _Listed | CompositeSpec[NodeSpec] | None = None
    parallel: _Listed | ParallelSpec[NodeSpec] | None = None
    inverter: InverterSpec | None = None
    one_shot: OneShotSpec | None = None
    repeat: RepeatSpec | None = None
    cooldown: CooldownSpec | None = None
    remap: RemapSpec | None = None
    condition: StatusConditionSpec | None = None
    if_then_else: IfThenElseSpec[NodeSpec] | None = None
    while_do_else: WhileDoElseSpec[NodeSpec] | None = None
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
    disabled: bool | OutcomeName | None = None

    @property
    def sequential(self) -> MachineSpec | None:
        """The states and the initial one of a machine or priority container."""
        return self.machine or self.priority

    @property
    def userdata(self) -> Mapping[str, object]:
        """The initial values of the container's own scope."""
        container = self.machine or self.concurrency or self.priority or self.foreach
        return container.userdata if container is not None else {}

    @property
    def is_disabled(self) -> bool:
        """Whether a run passes it over."""
        return self.disabled is not None and self.disabled is not False

    @property
    def passes_with(self) -> str:
        """The outcome by which it is passed over; empty inside a tree, and for a node that is not disabled."""
        return self.disabled if isinstance(self.disabled, str) else ""

    @property
    def own_name(self) -> str:
        """Its name inside a tree: as written, else derived from its kind."""
        if self.name is not None:
            return self.name
        return derived_name(self.state or self.behaviour or "", self.behavior or "", next(iter(self.kinds), ""))


TREE_KINDS = tuple(key for key in kind_keys(NodeSpec) if key not in KINDS)
"""Kinds allowed only inside a tree; `retry`, `timeout` and `guard` with a `child` are three more."""


def shared_keys(node: NodeSpec) -> tuple[str, ...]:
    """Return the keys that the branches of a concurrency container share; empty for other nodes."""
    return node.concurrency.shared if node.concurrency is not None else ()
