"""Resumes a run whose engine died, or starts one from a chosen event of any run.

Nodes that had ended are not repeated. An interrupted state follows its policy: the `resume` of the node, else that of
its class, else `ask` where it commands hardware and an operator is demanded, else `rerun`.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace

from engine.errors import Cause, ControlError, DocumentError
from engine.event import Event, NodeEntered
from engine.node_path import is_inside
from engine.runtime.history.checkpoint import Checkpoint
from engine.runtime.history.effective_events import effective_events
from engine.runtime.history.node_state import without_branch
from engine.runtime.history.resumable_state import ResumableState
from engine.runtime.history.run_state_part import RunStatePart
from engine.runtime.nodes.leaf import Leaf
from engine.runtime.nodes.node import Node
from engine.runtime.nodes.substitute_work import SUBSTITUTE
from engine.runtime.plan import Plan
from engine.runtime.record.node_checkpoint import NodeCheckpoint
from engine.wording.suggestions import did_you_mean

RERUN, ASK = "rerun", "ask"
_NEEDS_ENTRY = ("behavior", "foreach", "tree")
"""Kinds of containers whose children need more than userdata: parameters, items, the statuses of a tree."""


class ResumeDecisionRequired(ControlError):
    """Interrupted states need a decision; `questions` holds them with their outcomes."""

    def __init__(self, questions: Sequence[ResumeQuestion]) -> None:
        self.questions = tuple(questions)
        asked = "; ".join(f"{each.path} (rerun, {', '.join(each.outcomes)})" for each in questions)
        super().__init__(
            f"the run was interrupted in states that need a decision: {asked}",
            hint="check the cell, then answer each with `--answer PATH=rerun` or `--answer PATH=OUTCOME`",
        )


@dataclass(frozen=True, kw_only=True)
class ResumeQuestion:
    """An interrupted state that needs a decision."""

    path: str
    outcomes: tuple[str, ...]


def read_history(plan: Plan, run: str, events: Iterable[Event], *, until_seq: int | None = None) -> ResumableState:
    """Return the state of a run at its last event, or at `until_seq`."""
    return ResumableState(plan, run=run).read(effective_events(events), until_seq=until_seq)


def resume_checkpoint(
    history: ResumableState,
    plan: Plan,
    *,
    answers: Mapping[str, str],
    demanded: bool = False,
    last_seq: int,
    epoch: int = 1,
) -> Checkpoint:
    """Return the checkpoint to resume from, with a decision for every interrupted state.

    Args:
        history: The state of the run.
        plan: The behavior.
        answers: rerun, or an outcome, for states that ask; answers also override the policies of other states.
        demanded: Whether the run demands an operator.
        last_seq: The number of the last event in the journal; new events follow it.
        epoch: Number of the engine process of this run.

    Raises:
        ResumeDecisionRequired: states need a decision and have no answer.
        ControlError: an answer names an unknown state or outcome, or the run has ended.
    """
    if history.state.ended:
        raise ControlError("this run is over", where=history.state.run, hint="start a new one")
    for path in answers:
        if path not in history.active_states:
            hint = did_you_mean(path, history.active_states)
            raise ControlError("this state was not interrupted", where=path, hint=hint)
    policies = {
        path: answers.get(path) or resume_policy(plan.nodes[path], demanded=demanded) for path in history.active_states
    }
    questions = [
        ResumeQuestion(path=path, outcomes=tuple(plan.outcomes_of(path) or ()))
        for path, policy in policies.items()
        if policy == ASK
    ]
    if questions:
        raise ResumeDecisionRequired(questions)
    checkpoint = history.checkpoint(epoch=epoch)
    points = dict(checkpoint.points)
    taken = {path: policy for path, policy in policies.items() if policy != RERUN}
    for path, outcome in taken.items():
        known = plan.outcomes_of(path) or ()
        if outcome not in known:
            raise ControlError(f"there is no outcome {outcome!r}", where=path, hint=did_you_mean(outcome, known))
        message = f"the engine died while this state was active; its outcome is set to {outcome}"
        cause = Cause(message=message, where=path, kind="Resumed")
        points[path] = NodeCheckpoint(visit=points[path].visit, left=outcome, cause=cause, passed=True)
    return replace(
        checkpoint,
        seq=last_seq,
        points=points,
        taken=taken,
        rerun=tuple(path for path, policy in policies.items() if policy == RERUN),
    )


def resume_policy(node: Node, *, demanded: bool) -> str:
    """Return the policy for a state that a crash interrupted: rerun, ask, or an outcome."""
    if node.resume is not None:
        return node.resume
    work = node.work
    if not isinstance(work, Leaf):
        return RERUN
    if work.state.resume:
        return work.state.resume
    return ASK if demanded and work.commands_hardware else RERUN


def start_checkpoint(history: ResumableState, plan: Plan, path: str) -> Checkpoint:
    """Return `history` as the checkpoint of a new run that starts with the node at `path`.

    Containers around it have the userdata of that event, or their initial values where they were not active. Parallel
    branches resume from their state.

    Raises:
        ControlError: there is no such node, it is disabled, or it is inside a referenced behavior, a foreach or a tree
            that was not active.
    """
    if path not in plan.nodes:
        raise ControlError("there is no such node", where=path, hint=did_you_mean(path, plan.nodes))
    if plan.nodes[path].disabled is not None:
        raise ControlError("this node is disabled", where=path, hint="enable it, or start at the next node")
    checkpoint = history.checkpoint()
    points: dict[str, NodeCheckpoint] = {}
    around = [above for above in plan.nodes if above != path and is_inside(above, path)]
    for above in around:
        node = plan.nodes[above]
        name = path.removeprefix(f"{above}/").partition("/")[0]
        known = checkpoint.points.get(above)
        if known is None or not known.active:
            if node.work.kind in _NEEDS_ENTRY:
                what = "behavior" if node.work.kind == "behavior" else f"`{node.work.kind}`"
                raise ControlError(f"the enclosing {what} was not active then", where=above, hint=f"start at {above}")
            known = NodeCheckpoint(visit=1, values=node.work.initial_values({}))
        points[above] = replace(
            known,
            current=name,
            attempt=1,
            elapsed_s=0.0,
            preempted=without_branch(known.preempted, name),
            failed_clean_ups={branch: cause for branch, cause in known.failed_clean_ups.items() if branch != name},
        )
        if node.work.kind == "concurrency":
            points |= _parallel_points(checkpoint, above, name)
    return replace(checkpoint, points=points, rerun=(path,))


def _parallel_points(checkpoint: Checkpoint, container: str, name: str) -> dict[str, NodeCheckpoint]:
    """Return the checkpoints of the other branches of a concurrency container."""
    if container not in checkpoint.points:
        return {}
    own = f"{container}/{name}"
    return {
        path: point
        for path, point in checkpoint.points.items()
        if is_inside(container, path) and path != container and not is_inside(own, path)
    }


def last_entered_state(events: Iterable[Event], seq: int) -> str:
    """Return the state that was entered last up to event `seq`.

    Raises:
        DocumentError: no state was entered before.
    """
    last = _LastState()
    for event in events:
        if event.seq > seq:
            break
        last.take(event)
    if not last.path:
        raise DocumentError(f"no state was entered before event {seq}", hint="choose a later event")
    return last.path


def last_entry(events: Iterable[Event], path: str) -> int:
    """Return the number of the last event by which the node at `path` was entered; 0 where it never was."""
    entries = _Entries(path)
    for event in events:
        entries.take(event)
    return entries.seq


class _Entries(RunStatePart):
    """The last entry of one node."""

    def __init__(self, path: str) -> None:
        self._path = path
        self.seq = 0

    def node_entered(self, event: NodeEntered) -> None:
        """Keep the number of an entry."""
        if event.path == self._path:
            self.seq = event.seq


class _LastState(RunStatePart):
    """The state that was entered last."""

    def __init__(self) -> None:
        self.path = ""

    def node_entered(self, event: NodeEntered) -> None:
        """Keep the path of a state."""
        if event.kind in ("state", SUBSTITUTE):
            self.path = event.path
