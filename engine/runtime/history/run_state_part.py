"""The one place that tells the events about nodes apart; every part of the state of a run takes them from here."""

from __future__ import annotations

from engine.event import (
    BehaviorChanged,
    BranchesPreempted,
    Event,
    GatePassed,
    GateReached,
    GoalFinished,
    GoalSent,
    NodeDiverted,
    NodeEntered,
    NodeExited,
    NodeRetried,
    NodeSkipped,
    OperatorChanged,
    OperatorCommanded,
    RunEnded,
    RunResumed,
    RunStarted,
    RunSteppedBack,
    ServiceAnswered,
    ServiceCalled,
    StatusChanged,
    StopRequested,
    TransitionTaken,
    UndoEnded,
    UndoStarted,
    UserdataAppended,
    UserdataWritten,
)


class RunStatePart:
    """A part of the state of a run, changed by its events in order; it overrides what it needs.

    A view of a run asks the state and its changes; only a part sees events.
    """

    def take(self, event: Event) -> None:
        """Take the next event."""
        match event:
            case NodeEntered():
                self.node_entered(event)
            case NodeExited():
                self.node_exited(event)
            case TransitionTaken():
                self.transition_taken(event)
            case UserdataWritten() | UserdataAppended():
                self.value_written(event)
            case StatusChanged():
                self.status_changed(event)
            case GoalSent():
                self.request_sent(event, event.goal)
            case GoalFinished():
                self.goal_finished(event)
            case ServiceCalled():
                self.request_sent(event, event.call)
            case ServiceAnswered():
                self.call_answered(event)
            case NodeDiverted():
                self.node_diverted(event)
            case NodeRetried():
                self.node_retried(event)
            case BranchesPreempted():
                self.branches_preempted(event)
            case GateReached():
                self.gate_reached(event)
            case GatePassed():
                self.gate_passed(event)
            case OperatorCommanded():
                self.operator_commanded(event)
            case _:
                self._take_rare(event)

    def _take_rare(self, event: Event) -> None:
        match event:
            case NodeSkipped():
                self.node_skipped(event)
            case UndoStarted():
                self.undo_started(event)
            case UndoEnded():
                self.undo_ended(event)
            case RunSteppedBack():
                self.run_stepped_back(event)
            case BehaviorChanged():
                self.behavior_changed(event)
            case RunStarted():
                self.run_started(event)
            case RunResumed():
                self.run_resumed(event)
            case RunEnded():
                self.run_ended(event)
            case OperatorChanged() | StopRequested():
                self.supervision_changed()
            case _:
                pass

    def node_entered(self, event: NodeEntered) -> None:
        """Note that a node became active."""

    def node_exited(self, event: NodeExited) -> None:
        """Note that a node ended."""

    def node_diverted(self, event: NodeDiverted) -> None:
        """Note that a node was left for a target, without an outcome."""

    def node_skipped(self, event: NodeSkipped) -> None:
        """Note that a disabled node was passed over."""

    def node_retried(self, event: NodeRetried) -> None:
        """Note that a node waits for its next attempt."""

    def branches_preempted(self, event: BranchesPreempted) -> None:
        """Note that a condition preempts some branches."""

    def transition_taken(self, event: TransitionTaken) -> None:
        """Note that a container proceeds from a child."""

    def status_changed(self, event: StatusChanged) -> None:
        """Note that the status of a tree node changed."""

    def value_written(self, event: UserdataWritten | UserdataAppended) -> None:
        """Note that a key of userdata changed."""

    def request_sent(self, event: GoalSent | ServiceCalled, name: str) -> None:
        """Note that a state sent the goal or call `name`."""

    def goal_finished(self, event: GoalFinished) -> None:
        """Note that a goal ended."""

    def call_answered(self, event: ServiceAnswered) -> None:
        """Note that a call ended."""

    def gate_reached(self, event: GateReached) -> None:
        """Note that a node waits at the gate."""

    def gate_passed(self, event: GatePassed) -> None:
        """Note that a node continues after the gate."""

    def operator_commanded(self, event: OperatorCommanded) -> None:
        """Note that an operator gave a command."""

    def supervision_changed(self) -> None:
        """Note that the operator came or went, or a stop was requested."""

    def undo_started(self, event: UndoStarted) -> None:
        """Note that a step back begins to undo a state."""

    def undo_ended(self, event: UndoEnded) -> None:
        """Note that an undo ended."""

    def run_stepped_back(self, event: RunSteppedBack) -> None:
        """Note that the run stepped back, or could not."""

    def behavior_changed(self, event: BehaviorChanged) -> None:
        """Note that another version of the document is executed."""

    def run_started(self, event: RunStarted) -> None:
        """Note that the run started."""

    def run_resumed(self, event: RunResumed) -> None:
        """Note that another engine continues the run."""

    def run_ended(self, event: RunEnded) -> None:
        """Note that the run ended."""
