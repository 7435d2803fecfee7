"""The frames of the data stream: the subscription of a page, and the data that it receives."""

from __future__ import annotations

from typing import Annotated

import msgspec
from msgspec import Meta

from engine.messages import Pose
from engine.messages.device_state import DeviceLink, DeviceState
from engine.project import GoalInfo
from engine.runtime.history import MAX_WATCHES, ScopeView, Watch, WatchValue

MAX_CURVES = 32


class DataSubscription(msgspec.Struct, frozen=True, kw_only=True, tag="look", tag_field="k"):
    """From the client: subscribe to exactly this data.

    `number` is returned with the samples of these `fields`, each written `topic:path`. `traffic` requests rates,
    leases and goals, `topic` the messages of one topic, `run` the userdata of a run with the values of `watches`,
    `goals` the progress of the goals of a run, `cell` where the items of the cell are and what its tools hold.
    """

    number: int = 0
    traffic: bool = False
    topic: str = ""
    fields: tuple[str, ...] = ()
    run: str = ""
    watches: Annotated[tuple[Watch, ...], Meta(max_length=MAX_WATCHES)] = ()
    goals: str = ""
    cell: bool = False


class TopicMetrics(msgspec.Struct, frozen=True, kw_only=True):
    """Traffic of one topic: rate over the last seconds, age of the latest message (null before the first)."""

    rate_hz: float
    age_s: float | None
    on_demand: bool
    subscribers: int


class LeaseMetrics(msgspec.Struct, frozen=True, kw_only=True):
    """The lease of `resource`: its run, node and goal, which may be empty, and its duration."""

    resource: str
    run: str
    node: str
    goal: str
    held_s: float


class BusMetricsFrame(msgspec.Struct, frozen=True, kw_only=True, tag="traffic", tag_field="k"):
    """Metrics of the bus, once a second; a changed `shape` means that the list of the bus has changed."""

    shape: str
    topics: dict[str, TopicMetrics]
    leases: tuple[LeaseMetrics, ...]
    goals: tuple[GoalInfo, ...]


class MessageFrame(msgspec.Struct, frozen=True, kw_only=True, tag="message", tag_field="k"):
    """The latest message of the subscribed topic, truncated to a bounded size; at most five per second.

    `at_s` is the sampling time on the server's clock; `problem` tells why there is no message.
    """

    topic: str
    at_s: float
    value: object = None
    problem: str = ""


class SamplesFrame(msgspec.Struct, frozen=True, kw_only=True, tag="samples", tag_field="k"):
    """Rows of the chosen fields, in their order: time on the server's clock, and a value each (null where none).

    `dropped` is the number of earlier rows that were dropped because the page was too slow.
    """

    number: int
    times_s: tuple[float, ...]
    rows: tuple[tuple[float | None, ...], ...]
    dropped: int


class UserdataFrame(msgspec.Struct, frozen=True, kw_only=True, tag="userdata", tag_field="k"):
    """The changed scopes, by the path of their container; null for a removed one.

    `first` means that the frame contains all scopes. `watches` are the values of all watches, in their order.
    """

    run: str
    first: bool
    scopes: dict[str, ScopeView | None]
    watches: tuple[WatchValue, ...] = ()
    problem: str = ""


class GoalProgress(msgspec.Struct, frozen=True, kw_only=True):
    """An active goal: `share` is its progress from 0 to 1 if the feedback has it, `words` the feedback as text."""

    address: str
    status: str
    share: float | None
    words: str


class GoalsFrame(msgspec.Struct, frozen=True, kw_only=True, tag="goals", tag_field="k"):
    """All active goals of a run, by the path of the node that sent them."""

    run: str
    goals: dict[str, GoalProgress]


class ToolHolds(msgspec.Struct, frozen=True, kw_only=True):
    """Whether a tool holds something, and the name of the part: `?` when unknown, empty for none."""

    held: bool
    part: str


class DeviceNow(msgspec.Struct, frozen=True, kw_only=True):
    """A real device: whether it may move, and how fresh its readings are."""

    state: DeviceState
    link: DeviceLink | None = None


class CellStateFrame(msgspec.Struct, frozen=True, kw_only=True, tag="cell", tag_field="k"):
    """Where the items of the cell are now; at most five per second, and only after a change.

    `poses` are those of parts and frames in the world frame by name, rounded to 0.1 mm and 0.1 mrad; `cameras` those
    of the optical frames of cameras. `tools` are by the name of their arm, `devices` by their address on the bus.
    `modules` are the connectors of modules by their names, empty where one is not plugged.
    """

    poses: dict[str, Pose]
    cameras: dict[str, Pose]
    tools: dict[str, ToolHolds]
    devices: dict[str, DeviceNow] = {}
    modules: dict[str, str] = {}


class IdleFrame(msgspec.Struct, frozen=True, kw_only=True, tag="ping", tag_field="k"):
    """Keep-alive without data."""


DataFrame = BusMetricsFrame | MessageFrame | SamplesFrame | UserdataFrame | GoalsFrame | CellStateFrame | IdleFrame
