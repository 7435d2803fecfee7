"""Runs the steps of a composed state until one of them ends the sequence."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass

from engine.cause_chain import wrap_cause
from engine.errors import Cause
from engine.state import Context, Outcome, State
from states.motion.planned_motion_result import inner_cause_text


@dataclass(frozen=True)
class SequenceStep:
    """A state to run; `ends` maps each of its outcomes that ends the sequence to the outcome of the sequence."""

    state: State
    ends: Mapping[str, str]


@dataclass(frozen=True)
class SequenceEnd:
    """The outcome of a sequence that ended early, and its cause."""

    outcome: str
    cause: Cause | None

    def under(self, what: str, *, where: str, kind: str) -> Outcome:
        """Return the outcome with its reason; `what` becomes the outermost cause."""
        cause = wrap_cause(what, self.cause, where=where, kind=kind)
        return Outcome(self.outcome, {"reason": inner_cause_text(cause)}, cause)


async def run_steps(ctx: Context, steps: Iterable[SequenceStep]) -> SequenceEnd | None:
    """Run states in sequence; None if no step ended the sequence early."""
    for step in steps:
        outcome = await step.state.run(ctx)
        if outcome.name in step.ends:
            return SequenceEnd(step.ends[outcome.name], outcome.cause)
    return None
