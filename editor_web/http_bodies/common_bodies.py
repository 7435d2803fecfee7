"""JSON request and response bodies of `/api/v1`.

Responses are read from the engine's structs by attribute.
"""

from __future__ import annotations

from pydantic import BaseModel, ConfigDict, Field

from editor_web.security.authentication import OPERATOR, Role


class HttpBody(BaseModel):
    """Base of the HTTP bodies: frozen, read from attributes, unknown keys rejected."""

    model_config = ConfigDict(frozen=True, from_attributes=True, extra="forbid", populate_by_name=True)


class FindingBody(HttpBody):
    """One problem of a document."""

    severity: str
    code: str
    message: str
    path: str
    line: int
    column: int
    hint: str


class ParameterBody(HttpBody):
    """One parameter of a run, with the JSON Schema of its value."""

    name: str
    json_schema: dict[str, object] = Field(validation_alias="schema", serialization_alias="schema")
    required: bool


class TransitionBody(HttpBody):
    """A transition inside a machine."""

    source: str
    outcome: str
    target: str


class GraphNodeBody(HttpBody):
    """One node of the behavior with everything inside it."""

    path: str
    name: str
    kind: str
    title: str
    outcomes: tuple[str, ...]
    children: tuple[GraphNodeBody, ...]
    transitions: tuple[TransitionBody, ...]
    initial: str | None
    conditions: tuple[str, ...]


class BehaviorSummaryBody(HttpBody):
    """One line of the list of behaviors."""

    id: str
    name: str
    description: str
    errors: int
    warnings: int


class BehaviorBody(BehaviorSummaryBody):
    """One behavior with its form, findings and graph."""

    parameters: tuple[ParameterBody, ...]
    findings: tuple[FindingBody, ...]
    graph: GraphNodeBody | None
    view: dict[str, tuple[float, float]]
    success: tuple[str, ...]


class RunBody(HttpBody):
    """One run, active or ended."""

    id: str
    behavior: str
    status: str
    outcome: str | None
    success: bool
    cause: str
    started_at_s: float
    duration_s: float


class StartResultBody(HttpBody):
    """The run that was started."""

    run: str


class StopBody(HttpBody):
    """A request to stop a run; `reason` goes into its event log."""

    reason: str = Field(default="stopped in the dashboard", max_length=200)


class EventsBody(HttpBody):
    """A page of a run's events from the journal; `after=last` requests the next page."""

    events: tuple[dict[str, object], ...]
    last: int


class BusRequestBody(HttpBody):
    """A request to a service or action on the bus; `address` is `<namespace>/<skill_name>`."""

    address: str = Field(max_length=200)
    request: dict[str, object] = {}


class BusMessageBody(HttpBody):
    """A message to publish on a topic that takes commands."""

    topic: str = Field(max_length=200)
    message: dict[str, object]


class StopEndpointBody(HttpBody):
    """The STOP endpoint, independent of this server: POST `{"token": …, "reason": …}` as plain text to `url`."""

    url: str
    token: str


class ConnectionBody(HttpBody):
    """Whether every device of the cell is connected; `reason` names the lost device and why."""

    connected: bool
    reason: str


class ConnectBody(HttpBody):
    """A request to reconnect the lost devices of the cell."""


class SessionBody(HttpBody):
    """The role of the session and the features of this server; `stop` is for operators.

    The 3D view is at `http://<host>:<cell_view_port>/cell/<page>/`, a separate origin; null without a 3D view.
    """

    role: str
    cell_name: str
    cell_view_port: int | None
    epoch: str
    cell: ConnectionBody
    stop: StopEndpointBody | None = None


class LoginLinkRequest(HttpBody):
    """The role of the requested login link."""

    role: Role = OPERATOR


class LoginLinkBody(HttpBody):
    """A single-use login token, for `/login?t=<token>`."""

    token: str
    expires_in_s: float


class QuestionBody(HttpBody):
    """A state that was active when the engine crashed: a person must tell how it ended."""

    path: str
    outcomes: tuple[str, ...]


class ErrorBody(HttpBody):
    """Why a request failed: message, location (a parameter's name, a file, a node path) and hint."""

    message: str
    where: str
    hint: str


class ResumeQuestionsBody(ErrorBody):
    """An interrupted run resumes only after these questions are answered."""

    questions: tuple[QuestionBody, ...]
