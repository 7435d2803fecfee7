"""The nodes of trees with several children, which are ticked in an order, together, or by a condition.

The children are `NodeSpec`s (`node_spec.py`), in which these models stand.
"""

from __future__ import annotations

from typing import Annotated, Generic, Literal, TypeVar

from msgspec import Meta

from engine.document.nodes.node_kind import FormField
from engine.document.text.decoding import StrictModel

Child = TypeVar("Child")


class CompositeSpec(StrictModel, Generic[Child], frozen=True, kw_only=True):
    """Children of a sequence or selector; with `memory` a completed child is not ticked again.

    A plain list of children has memory.
    """

    children: Annotated[tuple[Child, ...], Meta(min_length=1, description="The children, at least one")]
    memory: Annotated[bool, FormField("Memory", "A child that is done is not asked again")]


class ParallelSpec(StrictModel, Generic[Child], frozen=True, kw_only=True):
    """Children ticked together; `policy` names the children that must succeed: `all`, `one`, or names.

    With `synchronise` a child that has succeeded is not restarted while the others run.

    With thresholds instead of a policy it succeeds when `success_count` children have succeeded (default: all) and
    fails when `failure_count` have failed (default: 1) or success is impossible; ended children are not restarted.
    """

    children: Annotated[tuple[Child, ...], Meta(min_length=1, description="The children, at least one")]
    policy: Annotated[
        Literal["all", "one"] | Annotated[tuple[str, ...], Meta(min_length=1)],
        FormField("Succeeds with", "`all`, `one`, or names of children as a list"),
    ] = "all"
    synchronise: Annotated[bool, FormField("Synchronise", "What has succeeded waits for the others")] = True
    success_count: Annotated[
        Annotated[int, Meta(ge=1, description="Number of children that must succeed")] | None,
        FormField("Successes", "So many must succeed, instead of a policy"),
    ] = None
    failure_count: Annotated[
        Annotated[int, Meta(ge=1, description="Number of children that must fail")] | None,
        FormField("Failures", "So many must fail, 1 without"),
    ] = None

    @property
    def counts(self) -> bool:
        """Whether it has thresholds instead of a policy."""
        return self.success_count is not None or self.failure_count is not None


class IfThenElseSpec(
    StrictModel,
    Generic[Child],
    frozen=True,
    kw_only=True,
    rename={"condition": "if", "body": "then", "otherwise": "else"},
):
    """Ticks `if` to its end once, then runs `then` after success or `else` after failure, with its status.

    Without `else` it fails if `if` has failed.
    """

    condition: Child
    body: Child
    otherwise: Child | None = None


class WhileDoElseSpec(
    StrictModel,
    Generic[Child],
    frozen=True,
    kw_only=True,
    rename={"condition": "while", "body": "do", "otherwise": "else"},
):
    """Runs `do` while `while` succeeds, `else` while it fails, with its status; without `else` it fails.

    `while` is repeated in the meantime like a check in a composite without memory. When its status changes, the
    active branch is halted and its clean-up awaited before the other branch starts.
    """

    condition: Child
    body: Child
    otherwise: Child | None = None
