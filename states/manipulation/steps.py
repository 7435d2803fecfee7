"""Goes through the steps of a composed state until one ends in a way that ends them all."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass

from engine.cause import under
from engine.event import Cause
from engine.state import Context, Outcome, State
from states.motion.free_end import reason_of


@dataclass(frozen=True)
class Step:
    """A state to go through; `ends` says for which of its outcomes the whole ends, and with which outcome."""

    state: State
    ends: Mapping[str, str]


@dataclass(frozen=True)
class Ended:
    """The outcome that the whole ends with, and why."""

    outcome: str
    cause: Cause | None

    def under(self, what: str, *, where: str, kind: str) -> Outcome:
        """Return the outcome with its reason, and `what` was not achieved on top of the causes."""
        cause = under(what, self.cause, where=where, kind=kind)
        return Outcome(self.outcome, {"reason": reason_of(cause)}, cause)


async def go_through(ctx: Context, steps: Iterable[Step]) -> Ended | None:
    """Run states one after the other; None when none of them ended the whole."""
    for step in steps:
        outcome = await step.state.run(ctx)
        if outcome.name in step.ends:
            return Ended(step.ends[outcome.name], outcome.cause)
    return None
