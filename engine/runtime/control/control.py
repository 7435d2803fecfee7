"""Operator commands to one run; every command is recorded as an event before it takes effect."""

from __future__ import annotations

import asyncio
from collections.abc import Callable, Sequence
from typing import Literal, Protocol

import msgspec

from engine.errors import ControlError
from engine.event import OperatorChanged, OperatorCommanded, PauseConfirmed, UserdataWritten
from engine.node_path import is_inside
from engine.preemption import preempt_for_order
from engine.runtime.control.autonomy import AutonomyLevel
from engine.runtime.control.breakpoint import Breakpoint
from engine.runtime.control.gate import Gate, GateWait, OperatorOrder, StepBackAction
from engine.runtime.control.single_step import SingleStep, StepMode
from engine.runtime.record.recorder import Recorder
from engine.runtime.scheduling.active_nodes import ActiveNodes
from engine.runtime.scheduling.hold import BranchHolds
from engine.runtime.scheduling.settlement import Settlement
from engine.runtime.userdata.active_scopes import ActiveScopes
from engine.runtime.userdata.userdata_value import plain_value
from engine.wording.suggestions import did_you_mean

LossPolicy = Literal["hold", "continue", "stop"]


class ControlView(msgspec.Struct, frozen=True, kw_only=True):
    """State of a run as shown to an operator."""

    paused: bool
    confirmed: bool
    """Whether everything to be held is at rest; False while it brakes, and while nothing is paused."""
    cannot: tuple[str, ...]
    """Goals that cannot be held."""
    waiting: tuple[GateWait, ...]
    locks: tuple[str, ...]
    breakpoints: tuple[Breakpoint, ...]
    autonomy: AutonomyLevel
    operator: str
    """none, attached, detached or lost."""
    active: tuple[str, ...]
    stepping: bool = False
    """Whether a step of the paused run is in progress."""
    demanded: bool = False
    """Whether outcomes are requested although no operator is attached."""
    loss_policy: LossPolicy = "hold"
    """Action taken `loss_timeout_s` after the operator is lost."""
    loss_timeout_s: float = 0.0

    @property
    def time_stands(self) -> bool:
        """Whether the displayed time of the run stands: it is paused, and no step is in progress."""
        return self.paused and not self.stepping

    @property
    def waits(self) -> str:
        """Why the run waits for a person: `asks` for an outcome, `paused` or `locked`; empty if it does not."""
        if any("autonomy" in each.reasons for each in self.waiting):
            return "asks"
        if self.paused:
            return "paused"
        return "locked" if any("lock" in each.reasons for each in self.waiting) else ""


class BehaviorStructure(Protocol):
    """What `Control` needs from the behavior."""

    def outcomes(self, path: str) -> Sequence[str] | None:
        """Return the possible outcomes of the node at `path`; None where there is no such node."""
        ...

    def paths(self) -> Sequence[str]:
        """Return the paths of all nodes."""
        ...


class Control:
    """Executes operator commands to one run; used on the loop thread.

    Args:
        gate: The gate of the run.
        branch_holds: The holds of goals and timers.
        activity: The active nodes of the run.
        settlement: Waits until the run has settled.
        recorder: The event log.
        structure: The behavior, for messages about unknown nodes and outcomes.
        scopes: The userdata that is active.
        stop: Stops the run with a reason.
        loss_policy: Reaction to the loss of the operator: hold the run, let it continue, or stop it.
        loss_timeout_s: Time between the loss and this reaction.
    """

    def __init__(
        self,
        *,
        gate: Gate,
        branch_holds: BranchHolds,
        activity: ActiveNodes,
        settlement: Settlement,
        recorder: Recorder,
        structure: BehaviorStructure,
        scopes: ActiveScopes,
        stop: Callable[[str], None],
        demanded: bool = False,
        loss_policy: LossPolicy = "hold",
        loss_timeout_s: float = 5.0,
    ) -> None:
        self.structure = structure
        self._scopes = scopes
        self._gate = gate
        self._branch_holds = branch_holds
        self._activity = activity
        self._settlement = settlement
        self._recorder = recorder
        self._stop = stop
        self._demanded = demanded
        self._loss_policy: LossPolicy = loss_policy
        self._loss_timeout_s = loss_timeout_s
        self._loss_timer: asyncio.TimerHandle | None = None
        self._operator = "none"
        self._closed = False
        self._confirmed = False
        gate.asks = demanded
        gate.on_paused = self._paused
        branch_holds.on_settled = self._settled
        gate.arm()

    @property
    def demanded(self) -> bool:
        """Whether the run needs an operator: autonomy rules apply although none is attached."""
        return self._demanded

    def pause(self) -> None:
        """Hold every goal and timer and block entries and exits of nodes; confirmed once everything is at rest."""
        self._record("pause")
        self._gate.pause()

    def resume(self) -> None:
        """Resume the run."""
        self._record("resume")
        self._gate.resume()

    def step(self, mode: StepMode = "into", path: str = "") -> None:
        """Execute one step of a paused run.

        Args:
            mode: into the next node, over the nodes inside it, or out of its container.
            path: The branch; by default the first one that waits, in order of arrival.

        Raises:
            ControlError: the run is not paused, or no node waits in that branch.
        """
        if not self._gate.paused:
            raise ControlError("the run is not paused", hint="pause it first, or set a breakpoint")
        self._refuse_if_undone("")
        waiting = self._first_waiting_in(path)
        if path and waiting is None:
            raise ControlError("no node waits there", where=path, hint=did_you_mean(path, self._gate.waiting))
        self._record("step", path, mode=mode)
        self._confirmed = False
        origin = waiting.path if waiting is not None else ""
        self._gate.step(SingleStep(mode=mode, branch=self._activity.branch_of(origin) if origin else "", origin=origin))

    def require_still(self) -> None:
        """Refuse a step back, or another value of userdata, of a run that is not paused or still executes a command.

        Raises:
            ControlError: it is running, stepping, or executing another command.
        """
        if self._closed or not self._gate.paused:
            raise ControlError("the run is not paused", hint="pause it first, or set a breakpoint")
        self._refuse_if_undone("")
        if self._gate.stepping or self._gate.ordered:
            raise ControlError("the run is executing another command", hint="wait until it is at rest")

    def step_back(self, cursor: str, path: str, target: str, back: StepBackAction) -> None:
        """Preempt the node at `path` and execute `back`; for `engine.runtime.run.Run.step_back`, which plans the step.

        Args:
            cursor: The node that waits or is active in the branch; recorded as the path of the command.
            path: The node that is preempted: the cursor, or a container around it.
            target: The node that is undone.
            back: Executes the undo.
        """
        self._record("step_back", cursor)
        self._confirmed = False
        self._gate.begin_undo(target, path)
        self._order(path, OperatorOrder(outcome=None, back=back))

    def lock(self, path: str, reason: str = "") -> None:
        """Hold the outcome of a node until `unlock`; transitions inside it still pass; `reason` is recorded."""
        self._require_node(path)
        self._record("lock", path, **({"reason": reason} if reason else {}))
        self._gate.locks.add(path)
        self._gate.arm()

    def unlock(self, path: str) -> None:
        """Release the outcome of a locked node."""
        if path not in self._gate.locks:
            raise ControlError("this node is not locked", where=path, hint=did_you_mean(path, self._gate.locks))
        self._record("unlock", path)
        self._gate.locks.discard(path)
        self._gate.arm()

    def force(self, path: str, outcome: str) -> None:
        """End an active or waiting node with an outcome; active nodes inside are preempted and clean up.

        Raises:
            ControlError: the node is not active, or has no such outcome.
        """
        known = self._require_node(path)
        if outcome not in known:
            raise ControlError(f"there is no outcome {outcome!r}", where=path, hint=did_you_mean(outcome, known))
        self._require_active(path)
        self._record("force", path, outcome=outcome)
        self._order(path, OperatorOrder(outcome=outcome))

    def repeat(self, path: str) -> None:
        """Run an active or waiting node again; active nodes inside are preempted and clean up first.

        Raises:
            ControlError: it is not active.
        """
        self._require_node(path)
        self._require_active(path)
        self._record("repeat", path)
        self._order(path, OperatorOrder(outcome=None))

    def restart(self, path: str) -> None:
        """Preempt an active node and enter it again, for a hot change; the hot change is the recorded command."""
        self._order(path, OperatorOrder(outcome=None))

    def answer(self, path: str) -> None:
        """Confirm the outcome that a node has requested.

        Raises:
            ControlError: the node has requested no outcome.
        """
        waiting = self._gate.waiting.get(path)
        if waiting is None or "autonomy" not in waiting.reasons:
            asking = [each.path for each in self._gate.waiting.values() if "autonomy" in each.reasons]
            raise ControlError("this node has requested no outcome", where=path, hint=did_you_mean(path, asking))
        self._record("answer", path, outcome=waiting.outcome)
        self._gate.answer(path)

    def set_userdata(self, scope: str, key: str, value: object) -> None:
        """Replace a value of the userdata of a paused run; what is read afterwards reads the new one.

        Args:
            scope: The path of the scope that holds the key, as in `UserdataWritten`; empty for the behavior's own.
            key: The key, which has a value already.
            value: Lists, mappings, text, numbers, true, false or null.

        Raises:
            ControlError: the run is not paused, or still executes a command.
            UserdataError: there is no such key, or the value cannot be stored.
        """
        self.require_still()
        owner = self._scopes.owning(scope, key)
        plain = plain_value(value, key=key, where=scope)
        self._record("set_userdata", scope, key=key, value=plain)
        owner.restore(scope, key, plain, defined=True)
        self._recorder.emit(UserdataWritten, path="", scope=scope, key=key, value=plain)

    def userdata(self, scope: str, key: str) -> object:
        """Return a value of an active scope as it is stored, whole; raises UserdataError where there is none."""
        return plain_value(self._scopes.owning(scope, key).own_values()[key], key=key, where=scope)

    def scopes_with(self, key: str) -> tuple[str, ...]:
        """Return the paths of the active scopes in which `set_userdata` can replace a key."""
        return self._scopes.with_key(key)

    def set_autonomy(self, level: AutonomyLevel) -> None:
        """Set the autonomy: outcomes that require less than `level` pass without confirmation."""
        self._record("autonomy", level=level)
        self._gate.autonomy = level
        self._gate.arm()

    def set_breakpoints(self, breakpoints: Sequence[Breakpoint]) -> None:
        """Replace all breakpoints; those that match no node are kept and logged as a warning."""
        self._record("breakpoints", breakpoints=[msgspec.to_builtins(each) for each in breakpoints])
        paths = self.structure.paths()
        for each in breakpoints:
            if not any(each.matches(path, each.when, each.outcomes[0] if each.outcomes else "") for path in paths):
                message = f"the breakpoint at {each.path} matches no node; {did_you_mean(each.path, paths)}"
                self._recorder.log("", message, level="warning")
        self._gate.breakpoints = tuple(breakpoints)
        self._gate.arm()

    def attach_operator(self) -> None:
        """Record that an operator is attached; autonomy rules apply."""
        self._cancel_loss_timer()
        self._set_operator("attached", asks=True)

    def detach_operator(self) -> None:
        """Record that the operator has detached; autonomy rules apply only where an operator is demanded."""
        self._cancel_loss_timer()
        self._set_operator("detached", asks=self._demanded)

    def lose_operator(self) -> None:
        """Record that the connection to the operator is lost; after the timeout the loss policy applies."""
        if self._operator != "attached":
            return
        self._set_operator("lost", asks=True)
        loop = asyncio.get_running_loop()
        self._loss_timer = loop.call_later(self._loss_timeout_s, self._apply_loss)

    async def settled(self) -> None:
        """Return when the immediate effects of a command have settled."""
        await self._settlement.settled(None)

    def view(self) -> ControlView:
        """Return the current state."""
        gate = self._gate
        return ControlView(
            paused=gate.paused,
            confirmed=self._confirmed and gate.paused,
            cannot=self._branch_holds.cannot(),
            waiting=tuple(gate.waiting.values()),
            locks=tuple(sorted(gate.locks)),
            breakpoints=gate.breakpoints,
            autonomy=gate.autonomy,
            operator=self._operator,
            active=tuple(self._activity.nodes),
            stepping=gate.stepping,
            demanded=self._demanded,
            loss_policy=self._loss_policy,
            loss_timeout_s=self._loss_timeout_s,
        )

    def close(self) -> None:
        """Close the control of a run that has ended; cancels its timer."""
        self._closed = True
        self._cancel_loss_timer()

    @property
    def closed(self) -> bool:
        """True once the run has ended."""
        return self._closed

    def _order(self, path: str, order: OperatorOrder) -> None:
        waiting = path in self._gate.waiting
        self._gate.order(path, order)
        task = self._activity.task_of(path)
        if not waiting and task is not None:
            self._branch_holds.let_clean_up(path)
            preempt_for_order(task)

    def _require_node(self, path: str) -> Sequence[str]:
        known = self.structure.outcomes(path)
        if known is None:
            raise ControlError("there is no such node", where=path, hint=did_you_mean(path, self.structure.paths()))
        return known

    def _refuse_if_undone(self, path: str) -> None:
        """Refuse a command for a node that a step back undoes; any command where `path` is empty."""
        for path_undone in self._gate.stepping_back:
            if not path or is_inside(path_undone, path):
                hint = "wait until the run is at rest, or stop it"
                raise ControlError("this node is being undone", where=path_undone, hint=hint)

    def _require_active(self, path: str) -> None:
        self._refuse_if_undone(path)
        if path not in self._activity.nodes and path not in self._gate.waiting:
            active = [*self._activity.nodes, *self._gate.waiting]
            raise ControlError("this node is not active", where=path, hint=did_you_mean(path, active))

    def _first_waiting_in(self, path: str) -> GateWait | None:
        return next((each for each in self._gate.waiting.values() if not path or is_inside(path, each.path)), None)

    def _paused(self) -> None:
        """React to a pause of any origin: it is confirmed once everything is at rest."""
        self._confirmed = False
        if self._branch_holds.settled():
            self._settled()

    def _settled(self) -> None:
        if self._confirmed or not self._gate.paused or self._gate.stepping:
            return
        self._confirmed = True
        self._recorder.emit(PauseConfirmed, cannot=self._branch_holds.cannot())

    def _apply_loss(self) -> None:
        self._loss_timer = None
        if self._loss_policy == "continue":
            self._gate.asks = self._demanded
            self._gate.arm()
        elif self._loss_policy == "hold":
            self.pause()
        else:
            self._stop("the operator was lost")

    def _cancel_loss_timer(self) -> None:
        if self._loss_timer is not None:
            self._loss_timer.cancel()
            self._loss_timer = None

    def _set_operator(self, status: str, *, asks: bool) -> None:
        recorder = self._recorder
        self._operator = status
        recorder.emit(OperatorChanged, status=status)
        self._gate.asks = asks
        self._gate.arm()

    def _record(self, command: str, path: str = "", **arguments: object) -> None:
        self._recorder.emit(OperatorCommanded, command=command, path=path, arguments=arguments)
