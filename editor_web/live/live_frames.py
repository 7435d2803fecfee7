"""The frames of the live stream, in both directions."""

from __future__ import annotations

from typing import Annotated

import msgspec

from editor_web.cell_view import LayerGroup
from editor_web.live.presence import PresenceChanged, ShowPresence
from editor_web.live.robot_status import RobotLive
from engine.project import CellStop
from engine.runtime.control import ControlView
from engine.runtime.history import LogLine, NodeLive, RunView
from engine.sweep_library import SweepLive

PROTOCOL_VERSION = 2


class Hello(msgspec.Struct, frozen=True, kw_only=True, tag="hello", tag_field="k"):
    """First frame; a changed `epoch` means that the server was restarted."""

    version: int
    epoch: str
    role: str
    server_time_s: float


class LiveSnapshot(msgspec.Struct, frozen=True, kw_only=True, tag="snapshot", tag_field="k"):
    """The complete state of the watched run (empty if none), all runs, newest first, and all arms.

    `now_s` is the run's clock at sending; it advances with wall time while `ticking`, and stands while the run is
    paused. `control` is null unless the run is active; `lock_reasons` are the texts of the operator, by the path of the
    locked node.
    """

    run: str
    seq: int
    now_s: float
    ticking: bool
    runs: tuple[RunView, ...]
    nodes: dict[str, NodeLive]
    log: tuple[LogLine, ...]
    control: ControlView | None
    lock_reasons: dict[str, str]
    robots: dict[str, RobotLive]
    stop: CellStop | None = None
    """The latest stop of the cell; changes of it come as `CellStopChanged`."""


class LiveDelta(msgspec.Struct, frozen=True, kw_only=True, tag="delta", tag_field="k"):
    """The changes of the watched run since `after`, the changed runs and arms, and the current control of the run.

    `dropped` is the number of missing log lines.
    """

    run: str
    after: int
    seq: int
    now_s: float
    ticking: bool
    runs: tuple[RunView, ...]
    nodes: dict[str, NodeLive]
    log: tuple[LogLine, ...]
    dropped: int
    control: ControlView | None
    lock_reasons: dict[str, str]
    robots: dict[str, RobotLive]


class DocumentsChanged(msgspec.Struct, frozen=True, kw_only=True, tag="documents", tag_field="k"):
    """Documents that have changed on disk, by id: their new hash, null if deleted."""

    changed: dict[str, str | None]


class StatesChanged(msgspec.Struct, frozen=True, kw_only=True, tag="states", tag_field="k"):
    """Modules of the project's own states were loaded anew, or could not be; how often since the server has started."""

    revision: int


class SweepsChanged(msgspec.Struct, frozen=True, kw_only=True, tag="sweeps", tag_field="k"):
    """How far sweeps are that are being executed, or have just ended, by id."""

    changed: dict[str, SweepLive]


class CellStopChanged(msgspec.Struct, frozen=True, kw_only=True, tag="stop", tag_field="k"):
    """The cell was stopped, what is open after it has changed, or it was released; null once it is closed."""

    stop: CellStop | None


class Ping(msgspec.Struct, frozen=True, kw_only=True, tag="ping", tag_field="k"):
    """Keep-alive; a page that does not answer with `Pong` in time is disconnected."""

    server_time_s: float


class WatchRun(msgspec.Struct, frozen=True, kw_only=True, tag="watch", tag_field="k"):
    """From the client: watch this run (empty: the list of runs only); the response is a snapshot."""

    run: str = ""


class OperateRun(msgspec.Struct, frozen=True, kw_only=True, tag="operate", tag_field="k"):
    """From the client: operate this run (empty: none); a lost connection is a lost operator."""

    run: str = ""


class ShowLayers(msgspec.Struct, frozen=True, kw_only=True, tag="show", tag_field="k"):
    """From the client: the 3D view under `/cell/<page>/` shows exactly these groups."""

    page: str
    groups: tuple[LayerGroup, ...]


class ScrubPath(msgspec.Struct, frozen=True, kw_only=True, tag="scrub", tag_field="k"):
    """From the client: show on its page alone where an arm is at a share, 0 to 1, of its proposed path; null: none."""

    page: str
    robot: str
    share: Annotated[float, msgspec.Meta(ge=0.0, le=1.0)] | None


class LookAt(msgspec.Struct, frozen=True, kw_only=True, tag="look", tag_field="k"):
    """From the client: turn the camera of its 3D view to the first of these names that the cell has.

    A name is that of a part, a frame or an arm.
    """

    page: str
    names: Annotated[tuple[str, ...], msgspec.Meta(max_length=50)]


class Pong(msgspec.Struct, frozen=True, kw_only=True, tag="pong", tag_field="k"):
    """From the client: answer to a ping."""


Frame = (
    Hello
    | LiveSnapshot
    | LiveDelta
    | DocumentsChanged
    | StatesChanged
    | SweepsChanged
    | CellStopChanged
    | PresenceChanged
    | Ping
)
Request = WatchRun | OperateRun | ShowLayers | ScrubPath | LookAt | ShowPresence | Pong
