"""The frames of the live stream, as the page gets and sends them."""

from __future__ import annotations

import msgspec

from editor_web.cell_view import LayerGroup
from editor_web.live.control_state import ControlLive
from editor_web.live.event_log import LogLine
from editor_web.live.robot_status import RobotLive
from editor_web.live.run_state import NodeLive

PROTOCOL_VERSION = 2


class RunOverview(msgspec.Struct, frozen=True, kw_only=True):
    """One run in the list of runs; `waits` is asks, paused or locked while it waits for somebody."""

    id: str
    behavior: str
    status: str
    outcome: str | None
    success: bool
    cause: str
    started_at_s: float
    duration_s: float
    waits: str


class Hello(msgspec.Struct, frozen=True, kw_only=True, tag="hello", tag_field="k"):
    """First frame; another `epoch` than before means that the server was restarted."""

    version: int
    epoch: str
    role: str
    server_time_s: float


class LiveSnapshot(msgspec.Struct, frozen=True, kw_only=True, tag="snapshot", tag_field="k"):
    """Everything of the watched run (empty when none is), all runs, newest first, and all arms.

    `now_s` is the run's clock at sending; it goes on with wall time while `ticking`. `control` is
    there while the run is under way.
    """

    run: str
    seq: int
    now_s: float
    ticking: bool
    runs: tuple[RunOverview, ...]
    nodes: dict[str, NodeLive]
    log: tuple[LogLine, ...]
    control: ControlLive | None
    robots: dict[str, RobotLive]


class LiveDelta(msgspec.Struct, frozen=True, kw_only=True, tag="delta", tag_field="k"):
    """What changed in the watched run since `after`, the runs and arms that changed, and the run's present control.

    `dropped` log lines are missing.
    """

    run: str
    after: int
    seq: int
    now_s: float
    ticking: bool
    runs: tuple[RunOverview, ...]
    nodes: dict[str, NodeLive]
    log: tuple[LogLine, ...]
    dropped: int
    control: ControlLive | None
    robots: dict[str, RobotLive]


class DocumentsChanged(msgspec.Struct, frozen=True, kw_only=True, tag="documents", tag_field="k"):
    """Documents that have changed on disk, by id: their hash now, null where they are gone."""

    changed: dict[str, str | None]


class Ping(msgspec.Struct, frozen=True, kw_only=True, tag="ping", tag_field="k"):
    """The connection lives; a page that does not answer with `Pong` for a while counts as gone."""

    server_time_s: float


class WatchRun(msgspec.Struct, frozen=True, kw_only=True, tag="watch", tag_field="k"):
    """From the client: show this run from now on (empty: the list of runs only); answered by a snapshot."""

    run: str = ""


class OperateRun(msgspec.Struct, frozen=True, kw_only=True, tag="operate", tag_field="k"):
    """From the client: I operate this run from now on (empty: none); losing the connection is losing the operator."""

    run: str = ""


class ShowLayers(msgspec.Struct, frozen=True, kw_only=True, tag="show", tag_field="k"):
    """From the client: the 3D view under `/cell/<page>/` shows these groups from now on, and no others."""

    page: str
    groups: tuple[LayerGroup, ...]


class Pong(msgspec.Struct, frozen=True, kw_only=True, tag="pong", tag_field="k"):
    """From the client: answer to a ping."""


Frame = Hello | LiveSnapshot | LiveDelta | DocumentsChanged | Ping
Request = WatchRun | OperateRun | ShowLayers | Pong
