"""Resumes a run whose engine died, or starts one from a chosen event of any run.

What had ended is not done again. A state in mid-work follows its policy: the node's `resume`, else
that of its class, else `ask` where it commands hardware and an operator is demanded, else `rerun`.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace

from engine.errors import ControlError, DocumentError
from engine.event import Cause, Event, NodeEntered, RunResumed
from engine.node_path import is_inside
from engine.runtime.history.checkpoint import Checkpoint
from engine.runtime.history.node_state import without_branch
from engine.runtime.history.run_reducer import RunStateReducer
from engine.runtime.nodes.leaf import Leaf
from engine.runtime.nodes.node import Node
from engine.runtime.nodes.substitute_work import SUBSTITUTE
from engine.runtime.plan import Plan
from engine.runtime.record.node_checkpoint import NodeCheckpoint
from engine.suggestions import did_you_mean

RERUN, ASK = "rerun", "ask"


class ResumeDecisionRequired(ControlError):
    """States in mid-work ask what to do with them; `questions` names them with their outcomes."""

    def __init__(self, questions: Sequence[ResumeQuestion]) -> None:
        self.questions = tuple(questions)
        asked = "; ".join(f"{each.path} (rerun, {', '.join(each.outcomes)})" for each in questions)
        super().__init__(
            f"the run was in the middle of what must be decided: {asked}",
            hint="look at the cell, then answer each with `--answer PATH=rerun` or `--answer PATH=OUTCOME`",
        )


@dataclass(frozen=True, kw_only=True)
class ResumeQuestion:
    """A state that was in mid-work and asks."""

    path: str
    outcomes: tuple[str, ...]


def effective_events(events: Iterable[Event]) -> list[Event]:
    """Return the events that count: a resumed run may have begun again before its last ones."""
    kept: list[Event] = []
    for event in events:
        if isinstance(event, RunResumed):
            while kept and kept[-1].seq > event.after_seq:
                kept.pop()
        kept.append(event)
    return kept


def read_history(plan: Plan, run: str, events: Iterable[Event], *, until_seq: int | None = None) -> RunStateReducer:
    """Return where a run stood at its end, or at one of its events."""
    return RunStateReducer(plan, run=run).read(effective_events(events), until_seq=until_seq)


def resume_checkpoint(
    history: RunStateReducer,
    plan: Plan,
    *,
    answers: Mapping[str, str],
    demanded: bool = False,
    last_seq: int,
    epoch: int = 1,
) -> Checkpoint:
    """Return the moment to go on from, every state in mid-work decided.

    Args:
        history: Where the run stood.
        plan: The behavior.
        answers: rerun, or an outcome, for states that ask; they also override the policy of others.
        demanded: Whether the run demands an operator.
        last_seq: The number of the last event that the journal holds; new ones come after it.
        epoch: Which engine of this run it is.

    Raises:
        ResumeDecisionRequired: states ask and have no answer.
        ControlError: an answer names no such state or outcome, or the run is over.
    """
    if history.ended:
        raise ControlError("this run is over", where=history.run, hint="start a new one")
    for path in answers:
        if path not in history.active_states:
            hint = did_you_mean(path, history.active_states)
            raise ControlError("this state was not interrupted", where=path, hint=hint)
    policies = {path: answers.get(path) or resume_policy(plan.nodes[path], demanded) for path in history.active_states}
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
        said = f"the engine died in the middle of it; taken as {outcome}"
        cause = Cause(message=said, where=path, kind="Resumed")
        points[path] = NodeCheckpoint(visit=points[path].visit, left=outcome, cause=cause, passed=True)
    return replace(
        checkpoint,
        seq=last_seq,
        points=points,
        taken=taken,
        rerun=tuple(path for path, policy in policies.items() if policy == RERUN),
    )


def resume_policy(node: Node, demanded: bool) -> str:
    """Return what becomes of a state that a crash found in mid-work: rerun, ask, or an outcome."""
    if node.resume is not None:
        return node.resume
    work = node.work
    if not isinstance(work, Leaf):
        return RERUN
    if work.state.resume:
        return work.state.resume
    return ASK if demanded and work.commands_hardware else RERUN


def start_checkpoint(history: RunStateReducer, plan: Plan, path: str) -> Checkpoint:
    """Return the moment of `history` as the start of a new run that begins with the node at `path`.

    Containers around it have the userdata of that moment, or their initial values where they were
    not active. Branches beside it go on as they stood.

    Raises:
        ControlError: there is no such node, or it is inside a referred behavior that was not active.
    """
    if path not in plan.nodes:
        raise ControlError("there is no such node", where=path, hint=did_you_mean(path, plan.nodes))
    moment = history.checkpoint()
    points: dict[str, NodeCheckpoint] = {}
    around = [above for above in plan.nodes if above != path and is_inside(above, path)]
    for above in around:
        node = plan.nodes[above]
        name = path.removeprefix(f"{above}/").partition("/")[0]
        known = moment.points.get(above)
        if known is None or not known.active:
            if node.work.kind == "behavior":
                raise ControlError("the behavior around it was not active then", where=above, hint="start before it")
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
            points |= _beside(moment, above, name)
    return replace(moment, points=points, rerun=(path,))


def _beside(moment: Checkpoint, container: str, name: str) -> dict[str, NodeCheckpoint]:
    """Return the points of the other branches of a concurrency container."""
    if container not in moment.points:
        return {}
    own = f"{container}/{name}"
    return {
        path: point
        for path, point in moment.points.items()
        if is_inside(container, path) and path != container and not is_inside(own, path)
    }


def last_entered_state(events: Iterable[Event], seq: int) -> str:
    """Return the state that was entered last at event `seq`.

    Raises:
        DocumentError: none was entered yet.
    """
    found = ""
    for event in events:
        if event.seq > seq:
            break
        if isinstance(event, NodeEntered) and event.kind in ("state", SUBSTITUTE):
            found = event.path
    if not found:
        raise DocumentError(f"no state was entered before event {seq}", hint="choose a later one")
    return found
