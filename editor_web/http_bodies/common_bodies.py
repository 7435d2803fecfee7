"""The JSON of the HTTP interface: what `/api/v1` takes and answers.

Answers are read from the backend's structs by attribute; field meanings are documented in `backend`.
"""

from __future__ import annotations

from pydantic import BaseModel, ConfigDict, Field

from editor_web.security.authentication import OPERATOR, Role


class HttpBody(BaseModel):
    """Root of the HTTP bodies: frozen, read from attributes, unknown keys refused."""

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
    """One value that is set per run, with the JSON Schema of its field."""

    name: str
    json_schema: dict[str, object] = Field(validation_alias="schema", serialization_alias="schema")
    required: bool


class TransitionBody(HttpBody):
    """An arrow inside a machine."""

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
    """One run, under way or over."""

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
    """A page of a run's events as the journal holds them; ask again with `after=last`."""

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
    """Where STOP is taken whatever this server does: POST `{"token": …, "reason": …}` as plain text to `url`."""

    url: str
    token: str


class ConnectionBody(HttpBody):
    """Whether every device of the cell is connected; `reason` says which is lost and why."""

    connected: bool
    reason: str


class ConnectBody(HttpBody):
    """A request to connect again what is lost of the cell."""


class SessionBody(HttpBody):
    """Who is logged in, and what this server has; `stop` is for operators.

    The 3D view is at `http://<host>:<cell_view_port>/cell/<page>/`, an origin of its own; null where there is none.
    """

    role: str
    cell_name: str
    cell_view_port: int | None
    epoch: str
    cell: ConnectionBody
    stop: StopEndpointBody | None = None


class LoginLinkRequest(HttpBody):
    """Whose log-in link is wanted."""

    role: Role = OPERATOR


class LoginLinkBody(HttpBody):
    """A token that logs a browser in once, at `/login?t=<token>`."""

    token: str
    expires_in_s: float


class QuestionBody(HttpBody):
    """A state that a crash found in mid-work: what became of it is for a person to say."""

    path: str
    outcomes: tuple[str, ...]


class ErrorBody(HttpBody):
    """Why a request failed: what, where (a parameter's name, a file, a node path), what to do."""

    message: str
    where: str
    hint: str


class ResumeQuestionsBody(ErrorBody):
    """An interrupted run cannot go on before these questions are answered."""

    questions: tuple[QuestionBody, ...]
