"""A run: one execution of one behavior, from its start to a reported outcome; it can be stopped at any time."""

from __future__ import annotations

import asyncio
import random
from collections.abc import Awaitable, Callable, Mapping, Sequence

import msgspec

from engine.bus import SkillBus
from engine.cause_chain import cause_of, describe_cause, wrap_cause
from engine.errors import Cause, FlexcellError, JournalError, NotStopped
from engine.event import RunEnded
from engine.journal import NullRunJournal, RunJournal
from engine.preemption import preempt_finally
from engine.runtime.control import Control, Gate
from engine.runtime.history.checkpoint import Checkpoint
from engine.runtime.history.hot_change import NO_SNAPSHOT, ChangeReport, VersionSnapshot
from engine.runtime.history.run_view import run_duration_s
from engine.runtime.hot_change_executor import HotChangeExecutor
from engine.runtime.nodes.diagnosis import explain_exit
from engine.runtime.nodes.execution import Execution
from engine.runtime.plan import Plan
from engine.runtime.record.node_exit import NodeExit
from engine.runtime.record.recorder import Recorder, Watcher
from engine.runtime.record.skill_port import BusPort, RunAwarePort, SkillPort
from engine.runtime.run_log import RunLog
from engine.runtime.run_options import RunOptions
from engine.runtime.run_result import RunResult
from engine.runtime.scheduling.hold import BranchHolds
from engine.runtime.userdata.userdata import Scope


class Run:
    """One execution of one plan on a bus; created and used on the loop thread.

    Args:
        plan: The plan that is executed.
        run: The run id.
        bus: The skill bus; its clock is the clock of the run.
        parameters: Values for the behavior's parameters.
        inputs: Initial values of userdata keys that the behavior declares.
        seed: Seed of its random numbers.
        journal: Durable store of its events; none by default.
        skills: Port used instead of the bus, for replays and fault injection.
        supervision: Operator, autonomy, breakpoints, timeouts.
        checkpoint: The checkpoint to resume from; of this run after a crash, or of another run.
        world: Returns the state of the simulated world, stored in the journal with every commit.
        instant_limit: Consecutive transitions without a wait before an endless loop is reported.
        polling_limit: Consecutive transitions in virtual time that only wait before a livelock is reported.

    Raises:
        DocumentError: a parameter or input is invalid.
    """

    def __init__(
        self,
        plan: Plan,
        *,
        run: str,
        bus: SkillBus,
        parameters: Mapping[str, object] | None = None,
        inputs: Mapping[str, object] | None = None,
        seed: int = 0,
        journal: RunJournal | None = None,
        skills: SkillPort | None = None,
        supervision: RunOptions | None = None,
        checkpoint: Checkpoint | None = None,
        world: Callable[[], Awaitable[bytes | None]] | None = None,
        instant_limit: int = 10_000,
        polling_limit: int = 20_000,
    ) -> None:
        self.id = run
        self.plan = plan
        self.seed = seed
        self.parameters = plan.checked_parameters(parameters or {})
        self._parameters = Scope("parameters", self.parameters)
        self._inputs = plan.checked_inputs(inputs or {})
        self._supervision = supervision or RunOptions()
        self._checkpoint = checkpoint
        self._is_resumed = checkpoint is not None and checkpoint.run == run
        self._journal = journal or NullRunJournal(run_id=run)
        self._recorder = Recorder(
            bus.clock,
            self._journal,
            after_seq=checkpoint.seq if checkpoint is not None and self._is_resumed else 0,
            after_s=checkpoint.time_s if checkpoint is not None and self._is_resumed else 0.0,
        )
        self._recorder.on_lost(self.fail)
        branch_holds = BranchHolds()
        self._execution = Execution(
            run=run,
            bus=bus,
            clock=bus.clock,
            recorder=self._recorder,
            random=random.Random(  # noqa: S311 - repeatable by its seed
                seed if checkpoint is None else f"{seed} after {checkpoint.seq}"
            ),
            skills=skills or BusPort(bus),
            branch_holds=branch_holds,
            gate=Gate(self._recorder, branch_holds),
            instant_limit=instant_limit,
            polling_limit=polling_limit,
            abandon_after_s=self._supervision.abandon_after_s,
            world=world,
        )
        branch_holds.is_preempted = self._execution.activity.is_preempted
        if checkpoint is not None:
            self._execution.points = dict(checkpoint.points)
            self._execution.is_resumed = self._is_resumed
            if self._is_resumed:
                self._execution.visits = dict(checkpoint.visits)
        self._log = RunLog(self._recorder)
        self._task: asyncio.Task[NodeExit] | None = None
        self._stop_reason: str | None = None
        self._failure: FlexcellError | None = None
        self._begun = False
        self._ended = False
        self._cancelled = False
        self._abandoned: asyncio.Future[None] = asyncio.get_running_loop().create_future()
        self._at_rest = asyncio.Event()
        self._abandon_timer: asyncio.TimerHandle | None = None
        self._control = self._new_control()
        if isinstance(skills, RunAwarePort):
            skills.begin(self._recorder)

    @property
    def control(self) -> Control:
        """Operator control of this run, from its creation to its end."""
        self._begin()
        return self._control

    @property
    def recorder(self) -> Recorder:
        """The event log, for events that are recorded from outside."""
        return self._recorder

    @property
    def ended(self) -> bool:
        """True once the run has ended."""
        return self._ended

    def outcomes(self, path: str) -> Sequence[str] | None:
        """Return the possible outcomes of the node at `path`; None where there is no such node."""
        return self.plan.outcomes_of(path)

    def paths(self) -> Sequence[str]:
        """Return the paths of all nodes."""
        return tuple(self.plan.nodes)

    def watch(self, watcher: Watcher) -> None:
        """Call `watcher` with every event of this run, on the loop thread."""
        self._recorder.watch(watcher)

    def stop(self, reason: str) -> None:
        """Preempt everything; `execute` returns when all clean-up is complete and the robots are at rest.

        A stop overrides pause, lock and autonomy. Before the start it prevents the start; later calls
        are recorded and change nothing; calls after the end do nothing.
        """
        if self._ended:
            return
        first = self._stop_reason is None
        self._stop_reason = self._stop_reason or reason
        if self._task is not None:
            self._log.stop_requested(reason)
            if first:
                # A branch held by a pause would never clean up.
                self._execution.branch_holds.let_clean_up(self.plan.root.path)
                preempt_finally(self._task)
                # Longer than any container inside waits for its children.
                abandon_after_s = self._supervision.abandon_after_s + 2.5
                self._abandon_timer = self._task.get_loop().call_later(abandon_after_s, self._give_up)

    async def _end_for(self, reason: str) -> None:
        self.stop(reason)
        await self._at_rest.wait()

    def fail(self, error: FlexcellError) -> None:
        """Stop like `stop`, and end as errored with this cause, which lies outside the behavior."""
        self._failure = self._failure or error
        self.stop(error.message)

    @property
    def active_states(self) -> tuple[str, ...]:
        """The paths of the active states, in order of entry."""
        nodes = self.plan.nodes
        # A branch that a hot change has removed is not in the plan while it cleans up.
        active = self._execution.activity.nodes
        return tuple(path for path in active if path not in nodes or not nodes[path].work.children)

    def change(self, plan: Plan, *, preempt: bool = False, kept: VersionSnapshot = NO_SNAPSHOT) -> ChangeReport:
        """Replace the behavior of this run, which must be paused or locked, by a new version.

        Args:
            plan: The new version.
            preempt: Whether active nodes that cannot continue, or whose parameters or keys changed, are preempted and
                entered again, and active branches that the new version removes are preempted.
            kept: The source texts of the version, required to replay the run.

        Raises:
            ControlError: the run cannot continue in the new version; it continues unchanged.
        """
        known = {name: value for name, value in self.parameters.items() if name in plan.parameters}
        required = [name for name, each in plan.parameters.items() if each.required and name not in known]
        checked = plan.checked_parameters(known) if not required else {}
        changing = HotChangeExecutor(execution=self._execution, control=self._control, log=self._log)
        report = changing.change(self.plan, plan, preempt=preempt, kept=kept)
        for key, value in checked.items():
            self._parameters.write(key, value)
        self.plan = plan
        return report

    async def step_back(self, path: str = "") -> tuple[str, ...]:
        """Undo the node that started last in one branch of this paused run; returns the undone nodes, in order.

        The `undo` of its states undoes it, its userdata is restored, and the run then waits before its entry, paused
        again. A failed undo is logged; the run then keeps its position.

        Args:
            path: The branch; by default the one in which something started last.

        Raises:
            ControlError: the run is not paused, or a node cannot be undone; nothing has moved.
            JournalError: the run has no journal, or it cannot be read.
        """
        # Imported here: step backs are rare, and this run is at rest meanwhile.
        from engine.runtime.step_back_executor import request_step_back

        return await request_step_back(
            path, plan=lambda: self.plan, execution=self._execution, control=self._control, journal=self._journal
        )

    async def execute(self) -> RunResult:
        """Execute the run and return its result; never raises for errors inside the behavior.

        Cancelling this call stops the run; CancelledError propagates after its clean-up.
        """
        self._begin()
        self._execution.bus.leases.on_claim(self.id, self._end_for)
        before = self._checkpoint.userdata if self._checkpoint is not None else self.plan.userdata
        scope = self._execution.scopes.open("", {**before, **self._inputs}, self._parameters)
        status, left, cause = await self._perform(scope)
        await self._release()
        self._at_rest.set()
        outcome = (left.target or left.outcome) if left is not None else None
        success = outcome in self.plan.success
        if left is not None and not success:
            cause = explain_exit(self.plan.root, left)
        if isinstance(self._execution.skills, RunAwarePort):
            self._execution.skills.end()
        self._ended = True
        self._control.close()
        end = await self._record_end(status, outcome, cause)
        if self._cancelled:
            raise asyncio.CancelledError
        return RunResult(
            run=self.id,
            behavior=self.plan.name,
            status=end.status,
            outcome=end.outcome,
            success=success and end.status == "finished",
            cause=end.cause,
            duration_s=run_duration_s(end),
            userdata=scope.own_values(),
            stood_in_for=self.plan.stood_in_for,
            abandoned=tuple(self._execution.abandoned),
        )

    async def _perform(self, scope: Scope) -> tuple[str, NodeExit | None, Cause | None]:
        if self._stop_reason is not None:
            self._log.stop_requested(self._stop_reason)
            return "stopped" if self._failure is None else "errored", None, self._stopped()
        root = self.plan.root
        with self._execution.settlement.owned():
            self._task = self._execution.activity.branch(root.path, root.perform(scope, self._execution))
        try:
            while not self._task.done():
                try:
                    await asyncio.wait({self._task, self._abandoned}, return_when=asyncio.FIRST_COMPLETED)
                except asyncio.CancelledError:
                    self._cancelled = True
                    self.stop("the process of the run was stopped")
                    continue
                if not self._task.done():
                    return "errored", None, self._abandon(self._task)
        finally:
            if self._abandon_timer is not None:
                self._abandon_timer.cancel()
        return self._result_of(self._task)

    def _result_of(self, task: asyncio.Task[NodeExit]) -> tuple[str, NodeExit | None, Cause | None]:
        try:
            return "finished", task.result(), None
        except asyncio.CancelledError:
            return "stopped" if self._failure is None else "errored", None, self._stopped()
        except FlexcellError as error:
            cause = cause_of(error)
            if self._failure is None and self._stop_reason is not None and not self._execution.abandoned:
                return "stopped", None, wrap_cause(self._stopped().message, cause, kind="Stopped")
            return "errored", None, cause
        except Exception as error:
            # A custom state may raise any exception; it ends the run with its cause, not the engine.
            self._recorder.log(self.plan.root.path, f"{type(error).__name__}: {error}", level="error")
            return "errored", None, cause_of(error)

    def _give_up(self) -> None:
        if not self._abandoned.done():
            self._abandoned.set_result(None)

    def _abandon(self, task: asyncio.Task[NodeExit]) -> Cause:
        waited_s = self._supervision.abandon_after_s
        leaves = self.active_states
        for path in leaves:
            self._execution.abandon(task, path, waited_s)
        error = NotStopped(
            f"{', '.join(leaves) or 'the run'} did not stop within {waited_s:g} s and was abandoned",
            where=self.plan.root.path,
            hint="the clean-up of the state must end, and CancelledError must propagate",
        )
        return cause_of(error)

    async def _release(self) -> None:
        """Cancel the remaining goals and release the leases, also when this task is cancelled meanwhile."""
        if self._execution.abandoned:
            return
        cancelling = asyncio.create_task(self._execution.bus.cancel_goals(self.id), name=f"goals of run {self.id}")
        while not cancelling.done():
            try:
                await asyncio.wait({cancelling})
            except asyncio.CancelledError:
                self._cancelled = True
        self._execution.bus.leases.release_run(self.id)
        cancelling.result()

    def _stopped(self) -> Cause:
        if self._failure is not None:
            return cause_of(self._failure)
        return Cause(message=f"stopped: {self._stop_reason or 'cancelled'}", where=self.plan.root.path, kind="Stopped")

    def _new_control(self) -> Control:
        control = Control(
            gate=self._execution.gate,
            branch_holds=self._execution.branch_holds,
            activity=self._execution.activity,
            settlement=self._execution.settlement,
            recorder=self._recorder,
            structure=self,
            scopes=self._execution.scopes,
            stop=self.stop,
            demanded=self._supervision.demand_operator,
            loss_policy=self._supervision.loss_policy,
            loss_timeout_s=self._supervision.loss_timeout_s,
        )
        gate = self._execution.gate
        gate.autonomy = self._supervision.autonomy
        gate.breakpoints = self._supervision.breakpoints
        gate.arm()
        return control

    def _begin(self) -> None:
        """Record the first events once, before any command, watcher or node."""
        if self._begun:
            return
        self._begun = True
        self._recorder.begin()
        checkpoint = self._checkpoint
        if checkpoint is not None and self._is_resumed:
            self._log.resumed(checkpoint)
        else:
            virtual = self._execution.clock.virtual
            self._log.started(self.plan, self.parameters, self._inputs, seed=self.seed, virtual=virtual)
            if checkpoint is not None:
                self._log.started_from(checkpoint)
        stepping_back = checkpoint.stepping_back if checkpoint is not None and self._is_resumed else ""
        if stepping_back:
            message = "the engine died while a step back was undoing this state; the run starts paused: step back again"
            self._recorder.log(stepping_back, message, level="warning")
        if self._supervision.start_paused or stepping_back:
            self._control.pause()

    async def _record_end(self, status: str, outcome: str | None, cause: Cause | None) -> RunEnded:
        """Make the end durable, then publish it; a run whose end cannot be stored is errored with that cause."""
        end = self._recorder.end(status, outcome, cause)
        committing = asyncio.create_task(self._execution.commit(), name=f"end of run {self.id}")
        while not committing.done():
            try:
                await asyncio.wait({committing})
            except asyncio.CancelledError:
                self._cancelled = True
        try:
            committing.result()
        except JournalError as error:
            end = msgspec.structs.replace(end, status="errored", outcome=None, cause=_unrecorded(error, end))
        self._recorder.publish(end)
        return end


def _unrecorded(error: JournalError, end: RunEnded) -> Cause:
    """Return the cause of a run whose end could not be written: the journal error and the result of the run."""
    if end.cause is not None and any(link.kind == JournalError.__name__ for link in end.cause.chain()):
        return end.cause
    lost = cause_of(error)
    own_end = end.outcome or end.status
    why = f" ({describe_cause(end.cause)})" if end.cause is not None else ""
    return msgspec.structs.replace(lost, message=f"{lost.message}; the run had ended with {own_end}{why}")
