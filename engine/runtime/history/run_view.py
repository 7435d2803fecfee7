"""One run as lists of runs show it."""

from __future__ import annotations

import msgspec

from engine.event import Event


class RunView(msgspec.Struct, frozen=True, kw_only=True):
    """One run, active or ended; `status` is running, stopping, finished, stopped, errored or interrupted.

    `behavior` is the id of its document, of a past run the name of the behavior. `duration_s` is on the clock of the
    run, see `run_duration_s`; of an active run it is the time so far, which advances with wall time while `ticking`.
    `waits` is asks, paused or locked while it waits for a person.
    """

    id: str
    behavior: str
    status: str
    outcome: str | None
    success: bool
    cause: str
    started_at_s: float
    duration_s: float
    waits: str = ""
    ticking: bool = False


def run_duration_s(last: Event | None) -> float:
    """Return how long a run took: the time of its last event on its clock, which is 0 at its start.

    Pauses count, and what happened before a crash counts of a run that was resumed; the time in between does not.
    """
    return last.time_s if last is not None else 0.0
