"""Goes through the steps of a composed state until one ends in a way that ends them all."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass

from engine.cause_chain import wrap_cause
from engine.event import Cause
from engine.state import Context, Outcome, State
from states.motion.planned_motion_result import inner_cause_text


@dataclass(frozen=True)
class SequenceStep:
    """A state to go through; `ends` says for which of its outcomes the whole ends, and with which outcome."""

    state: State
    ends: Mapping[str, str]


@dataclass(frozen=True)
class SequenceEnd:
    """The outcome that the whole ends with, and why."""

    outcome: str
    cause: Cause | None

    def under(self, what: str, *, where: str, kind: str) -> Outcome:
        """Return the outcome with its reason, and `what` was not achieved on top of the causes."""
        cause = wrap_cause(what, self.cause, where=where, kind=kind)
        return Outcome(self.outcome, {"reason": inner_cause_text(cause)}, cause)


async def run_steps(ctx: Context, steps: Iterable[SequenceStep]) -> SequenceEnd | None:
    """Run states one after the other; None when none of them ended the whole."""
    for step in steps:
        outcome = await step.state.run(ctx)
        if outcome.name in step.ends:
            return SequenceEnd(step.ends[outcome.name], outcome.cause)
    return None
