"""Bodies of `/api/v1` that the engine has no struct for: sessions, runs to start and stop, errors."""

from __future__ import annotations

from typing import Annotated

import msgspec
from msgspec import Meta

from editor_web.security.authentication import OPERATOR, Role
from engine.cell import CellConnection
from engine.check import CellFit
from engine.event import AnyEvent
from engine.library import BehaviorView
from engine.project import DrivenDeviceChoice
from engine.runtime.history import ResumeQuestion
from engine.stop import StopEndpoint

Name = Annotated[str, Meta(max_length=200)]


class RequestBody(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """Base of the bodies of requests: unknown keys are rejected."""


class BehaviorSummary(msgspec.Struct, frozen=True, kw_only=True):
    """One line of the list of behaviors: how many findings prevent a run, and how many do not."""

    id: str
    name: str
    description: str
    errors: int
    warnings: int
    fit: CellFit


class StartResultBody(msgspec.Struct, frozen=True, kw_only=True):
    """The run that was started."""

    run: str


class StopBody(RequestBody, frozen=True, kw_only=True):
    """A request to stop a run; `reason` goes into its event log."""

    reason: Name = "stopped in the dashboard"


class EventsBody(msgspec.Struct, frozen=True, kw_only=True):
    """A page of a run's events from the journal; `after=last` requests the next page."""

    events: tuple[AnyEvent, ...]
    last: int


class BusRequestBody(RequestBody, frozen=True, kw_only=True):
    """A request to a service or action on the bus; `address` is `<namespace>/<skill_name>`."""

    address: Name
    request: dict[str, object] = {}


class BusMessageBody(RequestBody, frozen=True, kw_only=True):
    """A message to publish on a topic that takes commands."""

    topic: Name
    message: dict[str, object]


class ConnectBody(RequestBody, frozen=True, kw_only=True):
    """A request to reconnect the lost devices of the cell."""


class SimulationBody(RequestBody, frozen=True, kw_only=True):
    """A request to open the cell anew: `simulated` are the devices that its world simulates instead of their drivers.

    All others with a driver are real.
    """

    simulated: Annotated[tuple[Annotated[str, Meta(max_length=200)], ...], Meta(max_length=100)]


class SessionBody(msgspec.Struct, frozen=True, kw_only=True):
    """The role of the session and the features of this server; `stop` is for operators.

    The 3D view is at `http://<host>:<cell_view_port>/cell/<page>/`, a separate origin; null without a 3D view.
    """

    role: str
    cell_name: str
    cell_view_port: int | None
    epoch: str
    cell: CellConnection
    devices: tuple[DrivenDeviceChoice, ...] = ()
    """The devices with a driver of their own, and whether they are real or simulated now."""
    opening_problem: str = ""
    """Why the cell was not opened as it was asked for last; it is open as it was before."""
    stop: StopEndpoint | None = None


class LoginLinkRequest(RequestBody, frozen=True, kw_only=True):
    """The role of the requested login link."""

    role: Role = OPERATOR


class LoginLinkBody(msgspec.Struct, frozen=True, kw_only=True):
    """A single-use login token, for `/login?t=<token>`."""

    token: str
    expires_in_s: float


class ErrorBody(msgspec.Struct, frozen=True, kw_only=True):
    """Why a request failed: message, location (a parameter's name, a file, a node path) and hint."""

    message: str
    where: str
    hint: str


class ResumeQuestionsBody(ErrorBody, frozen=True, kw_only=True):
    """An interrupted run resumes only after these questions are answered."""

    questions: tuple[ResumeQuestion, ...]


def summary_of(view: BehaviorView) -> BehaviorSummary:
    """Return the line of a behavior in the list."""
    return BehaviorSummary(
        id=view.id,
        name=view.name,
        description=view.description,
        errors=view.errors,
        warnings=view.warnings,
        fit=view.fit,
    )
