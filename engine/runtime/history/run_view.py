"""One run as lists of runs show it."""

from __future__ import annotations

import msgspec


class RunView(msgspec.Struct, frozen=True, kw_only=True):
    """One run, active or ended; `status` is running, stopping, finished, stopped, errored or interrupted.

    `behavior` is the id of its document, of a past run the name of the behavior. `duration_s` is on the clock of the
    run. `waits` is asks, paused or locked while it waits for a person.
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
