"""The gate of a run: every node passes it before its entry and between its outcome and the transition.

While nothing holds the run, `armed` is False and nodes skip the gate.
"""

from __future__ import annotations

from collections.abc import Awaitable, Callable
from dataclasses import dataclass, replace

from engine.cause_chain import cause_of, describe_cause
from engine.document.expression.expression_cost import MAX_STEPS
from engine.document.expression.step_meter import METER
from engine.errors import FlexcellError
from engine.event import GatePassed, GateReached, OutcomeRequested, OutcomeWithdrawn
from engine.node_path import is_inside
from engine.runtime.control.autonomy import AutonomyLevel, passes_by_itself
from engine.runtime.control.breakpoint import Breakpoint, GatePoint
from engine.runtime.control.single_step import SingleStep
from engine.runtime.record.node_exit import NodeExit
from engine.runtime.record.recorder import Recorder
from engine.runtime.scheduling.hold import BranchHolds
from engine.runtime.userdata.userdata import Scope

PAUSE = "pause"
StepBackAction = Callable[[Scope], Awaitable[NodeExit | None]]


@dataclass(frozen=True, kw_only=True)
class OperatorOrder:
    """Order to a node: end with `outcome`, or, without one, run again after the step back `back`."""

    outcome: str | None
    back: StepBackAction | None = None
    """Undoes this node, or the one before it, and returns the exit of the node; None where the node stays."""


@dataclass(frozen=True, kw_only=True)
class GateWait:
    """A node that waits at the gate: gate point, visit, and reasons.

    `required` is the autonomy level that the outcome requires; empty before an entry.
    """

    path: str
    visit: int
    point: GatePoint
    outcome: str = ""
    reasons: tuple[str, ...] = ()
    required: str = ""


class Gate:
    """Holds nodes at their entries and exits; belongs to one run, used on the loop thread."""

    def __init__(self, recorder: Recorder, branch_holds: BranchHolds) -> None:
        self.armed = False
        self.waiting: dict[str, GateWait] = {}
        self.locks: set[str] = set()
        self.breakpoints: tuple[Breakpoint, ...] = ()
        self.autonomy: AutonomyLevel = "full"
        self.asks = False
        """Whether autonomy rules apply: an operator is attached, or demanded."""
        self._hits: dict[Breakpoint, int] = {}
        self._orders: dict[str, OperatorOrder] = {}
        self._answers: set[str] = set()
        self._accepted: dict[str, tuple[int, str]] = {}
        self.on_paused: Callable[[], None] = lambda: None
        """Called after every pause: by the operator, a breakpoint, or the end of a step."""
        self.stepping_back: tuple[str, ...] = ()
        """The node that is being undone, and the node that was preempted for it; empty while there is none."""
        self._step: SingleStep | None = None
        self._paused = False
        self._recorder = recorder
        self._branch_holds = branch_holds

    @property
    def paused(self) -> bool:
        """Whether the operator (or a breakpoint) has paused the run."""
        return self._paused

    @property
    def stepping(self) -> bool:
        """Whether a step is in progress."""
        return self._step is not None

    def arm(self) -> None:
        """Update `armed` and wake the nodes that wait; call it after every change."""
        self.armed = bool(
            self._paused
            or self._branch_holds.active
            or self.locks
            or self.asks
            or self._orders
            or any(each.enabled for each in self.breakpoints)
        )
        self._branch_holds.wake()

    def pause(self) -> None:
        """Hold every branch."""
        self._paused, self._step = True, None
        self._branch_holds.hold(PAUSE, self._covers)
        self.arm()
        self.on_paused()

    def resume(self) -> None:
        """Resume every branch."""
        self._paused, self._step = False, None
        self._branch_holds.release(PAUSE)
        self.arm()

    def step(self, step: SingleStep) -> None:
        """Release one branch until the step ends."""
        self._step = step
        self._branch_holds.hold(PAUSE, self._covers)
        self.arm()

    def begin_undo(self, path: str, gives_up: str) -> None:
        """Release only the undo of the node at `path`; `gives_up` is the node that is preempted for it."""
        self.stepping_back = (path, gives_up)
        self.step(SingleStep(mode="back", branch=path, origin=path))

    def undoes(self, path: str) -> bool:
        """Return whether the node at a path is being undone; no priority container holds an undo."""
        return bool(self.stepping_back) and is_inside(self.stepping_back[0], path)

    def end_undo(self) -> None:
        """Hold everything again, regardless of orders given meanwhile."""
        self.stepping_back = ()
        self.pause()

    def order(self, path: str, order: OperatorOrder) -> None:
        """Give an order to a node that waits at the gate or was just preempted."""
        self._orders[path] = order
        self.arm()

    @property
    def ordered(self) -> bool:
        """Whether nodes have orders that they have not executed yet."""
        return bool(self._orders)

    def has_order(self, path: str) -> bool:
        """Return whether a node has an order."""
        return path in self._orders

    def taken_order(self, path: str) -> OperatorOrder | None:
        """Take the order of a node; its clean-up for the order is complete."""
        self._branch_holds.has_cleaned_up(path)
        return self._orders.pop(path, None)

    def has_order_around(self, path: str) -> bool:
        """Return whether a container around the node has an order."""
        return any(other != path and is_inside(other, path) for other in self._orders)

    def answer(self, path: str) -> None:
        """Confirm the requested outcome of a node."""
        self._answers.add(path)
        self.arm()

    async def before(self, path: str, visit: int, scope: Scope) -> OperatorOrder | None:
        """Wait until the node may be entered; return an order given instead."""
        self._arrive(path, "before", "", scope)
        return await self._wait(GateWait(path=path, visit=visit, point="before"), required=None)

    async def after(self, path: str, visit: int, outcome: str, required: str, scope: Scope) -> OperatorOrder | None:
        """Wait until the transition of the outcome may be taken; return an order given instead.

        Args:
            path: The path of the node.
            visit: The number of its activation.
            outcome: Its outcome; empty when timeout, guard or on_error diverted it.
            required: The autonomy level that the outcome requires; at this level or below it needs confirmation.
            scope: The scope in which breakpoint conditions are evaluated.
        """
        self._arrive(path, "after", outcome, scope)
        accepted = self._accepted.pop(path, None) == (visit, outcome)
        waiting = GateWait(path=path, visit=visit, point="after", outcome=outcome)
        return await self._wait(waiting, required=None if accepted or not outcome else required)

    async def offer(self, path: str, visit: int, outcome: str, required: str) -> None:
        """Ask the operator to confirm an outcome that a running state offers; cancelling withdraws the request."""
        if not self.asks or passes_by_itself(required, self.autonomy):
            return
        waiting = GateWait(path=path, visit=visit, point="after", outcome=outcome)
        if await self._wait(waiting, required=required) is None:
            self._accepted[path] = (visit, outcome)

    async def _wait(self, waiting: GateWait, *, required: str | None) -> OperatorOrder | None:
        path = waiting.path
        is_requested = required is not None and self._still_asks(required)
        if required is not None and is_requested:
            self._recorder.emit(
                OutcomeRequested, path=path, visit=waiting.visit, outcome=waiting.outcome, required=required
            )
        try:
            while (order := self._orders.pop(path, None)) is None:
                unanswered = is_requested and path not in self._answers and self._still_asks(required)
                reasons = self._reasons(waiting, unanswered=unanswered)
                if not reasons:
                    break
                self._record_wait(replace(waiting, reasons=reasons, required=required or ""))
                await self._branch_holds.changed()
            return order
        finally:
            self._answers.discard(path)
            if is_requested:
                self._recorder.emit(OutcomeWithdrawn, path=path, visit=waiting.visit, outcome=waiting.outcome)
            if self.waiting.pop(path, None) is not None:
                self._recorder.emit(GatePassed, path=path, visit=waiting.visit, point=waiting.point)

    def _still_asks(self, required: str | None) -> bool:
        return self.asks and required is not None and not passes_by_itself(required, self.autonomy)

    def _reasons(self, waiting: GateWait, *, unanswered: bool) -> tuple[str, ...]:
        reasons = list(self._branch_holds.reasons(waiting.path))
        if waiting.point == "after" and waiting.path in self.locks:
            reasons.append("lock")
        if unanswered:
            reasons.append("autonomy")
        return tuple(reasons)

    def _arrive(self, path: str, point: GatePoint, outcome: str, scope: Scope) -> None:
        """Pause at a breakpoint or at the end of a step."""
        if self._step is not None and self._step.ends_at(path, point):
            self.pause()
            return
        with METER.limited(MAX_STEPS, "the breakpoints here"):
            for each in self.breakpoints:
                if each.matches(path, point, outcome) and self._is_hit(each, path, scope):
                    self._recorder.log(path, f"breakpoint {point} {each.path}")
                    if each.once:
                        self.breakpoints = tuple(other for other in self.breakpoints if other is not each)
                    self.pause()
                    return

    def _is_hit(self, each: Breakpoint, path: str, scope: Scope) -> bool:
        try:
            if not each.holds(lambda name: scope.read(name, reader=path)):
                return False
        except FlexcellError as error:
            # A condition that cannot be evaluated must not end the run; the run pauses so that the error is visible.
            self._recorder.log(path, f"breakpoint {each.path}: {describe_cause(cause_of(error))}")
            return True
        hits = self._hits[each] = self._hits.get(each, 0) + 1
        return hits >= each.hits

    def _record_wait(self, waiting: GateWait) -> None:
        known = self.waiting.get(waiting.path)
        self.waiting[waiting.path] = waiting
        if known is not None and known.reasons == waiting.reasons:
            return
        self._recorder.emit(
            GateReached,
            path=waiting.path,
            visit=waiting.visit,
            point=waiting.point,
            reasons=waiting.reasons,
            outcome=waiting.outcome,
        )

    def _covers(self, path: str) -> bool:
        return self._step is None or not self._step.frees(path)
