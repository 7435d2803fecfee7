"""Events: the frozen facts of a run, the only thing journal, browser and replay ever see.

`time_s` is the run's own clock (0 at the start); `seq` counts from 1 without gaps. `path` is the
node path `root/approach/left`; `visit` counts the activations of that path in this run.
"""

from __future__ import annotations

import msgspec


class Cause(msgspec.Struct, frozen=True, kw_only=True, omit_defaults=True):
    """One link of the chain that explains a failure; `because` is the link below it."""

    message: str
    where: str = ""
    kind: str = ""
    because: Cause | None = None

    def chain(self) -> tuple[Cause, ...]:
        """Return the links from the outermost to the root cause."""
        links: list[Cause] = []
        link: Cause | None = self
        while link is not None:
            links.append(link)
            link = link.because
        return tuple(links)


class Event(msgspec.Struct, frozen=True, kw_only=True, tag_field="event"):
    """One fact of a run."""

    seq: int
    time_s: float


class RunStarted(Event, frozen=True, kw_only=True, tag="run_started"):
    """The run begins; `document` is the content hash of the behavior's meaning."""

    behavior: str
    document: str
    parameters: dict[str, object]
    seed: int
    clock: str


class Entered(Event, frozen=True, kw_only=True, tag="entered"):
    """A node became active."""

    path: str
    visit: int
    kind: str
    inputs: dict[str, object]


class Exited(Event, frozen=True, kw_only=True, tag="exited", omit_defaults=True):
    """A node finished with an outcome; `preempted` when it was told to stop instead."""

    path: str
    visit: int
    outcome: str
    preempted: bool = False
    cause: Cause | None = None


class UserdataWritten(Event, frozen=True, kw_only=True, tag="userdata"):
    """A node wrote `key` into the scope of the container `scope`."""

    path: str
    scope: str
    key: str
    value: object


class Transitioned(Event, frozen=True, kw_only=True, tag="transition"):
    """Machine `path` follows the outcome of `source` to `target`, a child or an own outcome."""

    path: str
    source: str
    outcome: str
    target: str


class GoalSent(Event, frozen=True, kw_only=True, tag="goal"):
    """A state sent an action goal or service request."""

    path: str
    goal: str
    address: str
    request: dict[str, object]


class GoalFinished(Event, frozen=True, kw_only=True, tag="goal_finished", omit_defaults=True):
    """The goal ended: succeeded, canceled, aborted or rejected."""

    path: str
    goal: str
    status: str
    result: dict[str, object] | None = None
    cause: Cause | None = None


class Logged(Event, frozen=True, kw_only=True, tag="log"):
    """A state or the runner says something; `level` is debug, info, warning or error."""

    path: str
    level: str
    message: str


class Retried(Event, frozen=True, kw_only=True, tag="retry"):
    """A node is run again after a failure; `attempt` counts from 2."""

    path: str
    attempt: int
    wait_s: float
    cause: Cause | None = None


class StopRequested(Event, frozen=True, kw_only=True, tag="stop"):
    """Somebody asked the run to stop."""

    reason: str


class RunEnded(Event, frozen=True, kw_only=True, tag="run_ended", omit_defaults=True):
    """The run is over; `status` is finished, stopped or errored."""

    status: str
    outcome: str | None = None
    cause: Cause | None = None


AnyEvent = (
    RunStarted
    | Entered
    | Exited
    | UserdataWritten
    | Transitioned
    | GoalSent
    | GoalFinished
    | Logged
    | Retried
    | StopRequested
    | RunEnded
)
