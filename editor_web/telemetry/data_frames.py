"""The frames of the data stream: what a page says it looks at, and what it is sent of that."""

from __future__ import annotations

import msgspec

MAX_CURVES = 32


class DataSubscription(msgspec.Struct, frozen=True, kw_only=True, tag="look", tag_field="k"):
    """From the client: I look at this from now on, and at nothing else.

    `number` comes back with the samples of these `fields`, each written `topic:path`. `traffic` asks for
    rates, leases and goals, `topic` for the messages of one topic, `run` for the userdata of a run, `goals` for
    how far the goals of a run are.
    """

    number: int = 0
    traffic: bool = False
    topic: str = ""
    fields: tuple[str, ...] = ()
    run: str = ""
    goals: str = ""


class TopicMetrics(msgspec.Struct, frozen=True, kw_only=True):
    """Traffic of one topic: rate over the last seconds, age of the latest message (null before the first)."""

    rate_hz: float
    age_s: float | None
    on_demand: bool
    subscribers: int


class LeaseMetrics(msgspec.Struct, frozen=True, kw_only=True):
    """Who commands `resource`, for how long, from which node and with which goal; both may be empty."""

    resource: str
    run: str
    node: str
    goal: str
    held_s: float


class GoalMetrics(msgspec.Struct, frozen=True, kw_only=True):
    """A goal under way."""

    id: str
    address: str
    run: str
    node: str
    status: str


class BusMetricsFrame(msgspec.Struct, frozen=True, kw_only=True, tag="traffic", tag_field="k"):
    """What passes on the bus, once a second; another `shape` means that the list of what there is has changed."""

    shape: str
    topics: dict[str, TopicMetrics]
    leases: tuple[LeaseMetrics, ...]
    goals: tuple[GoalMetrics, ...]


class MessageFrame(msgspec.Struct, frozen=True, kw_only=True, tag="message", tag_field="k"):
    """The newest message of the topic that is looked at, cut to a bounded size; at most five a second.

    `at_s` is the server's clock when it was looked at; `problem` says why there is none.
    """

    topic: str
    at_s: float
    value: object = None
    problem: str = ""


class SamplesFrame(msgspec.Struct, frozen=True, kw_only=True, tag="samples", tag_field="k"):
    """Rows of the chosen fields, in their order: time on the server's clock, and a value each (null where none).

    `dropped` rows in front of these were left out, as the page did not take them in time.
    """

    number: int
    times_s: tuple[float, ...]
    rows: tuple[tuple[float | None, ...], ...]
    dropped: int


class UserdataValue(msgspec.Struct, frozen=True, kw_only=True):
    """One value of userdata: who wrote it last (empty: it began so), when on the run's clock, how often."""

    value: object
    by: str
    at_s: float
    writes: int


class UserdataScope(msgspec.Struct, frozen=True, kw_only=True):
    """The values of one container; `is_open` while it is active."""

    is_open: bool
    since_s: float
    values: dict[str, UserdataValue]


class UserdataFrame(msgspec.Struct, frozen=True, kw_only=True, tag="userdata", tag_field="k"):
    """The scopes that have changed, by the path of their container; null for one that is no more.

    `first` means that these are all there are.
    """

    run: str
    first: bool
    scopes: dict[str, UserdataScope | None]
    problem: str = ""


class GoalProgress(msgspec.Struct, frozen=True, kw_only=True):
    """A goal under way: `share` of its way from 0 to 1 where its feedback tells it, and else what it tells in words."""

    address: str
    status: str
    share: float | None
    words: str


class GoalsFrame(msgspec.Struct, frozen=True, kw_only=True, tag="goals", tag_field="k"):
    """The goals that a run has under way, all of them, by the path of the node that sent them."""

    run: str
    goals: dict[str, GoalProgress]


class IdleFrame(msgspec.Struct, frozen=True, kw_only=True, tag="ping", tag_field="k"):
    """Nothing happened; the connection lives."""


DataFrame = BusMetricsFrame | MessageFrame | SamplesFrame | UserdataFrame | GoalsFrame | IdleFrame
