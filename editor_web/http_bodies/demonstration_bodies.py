"""JSON bodies for a behavior proposed from taught entries."""

from __future__ import annotations

from typing import Annotated

from pydantic import Field

from editor_web.http_bodies.common_bodies import FindingBody, HttpBody
from engine.skills.proposing import Role, StepKind, ToolName

EntryName = Annotated[str, Field(min_length=1, max_length=128)]
ShortText = Annotated[str, Field(max_length=128)]


class DemonstrationStepBody(HttpBody):
    """An entry, or an action `open` or `close` of the tool, in order; without a role, the role is inferred."""

    kind: StepKind
    name: EntryName
    role: Role | None = None
    part: ShortText | None = None


class ProposedStepBody(HttpBody):
    """A step with its role, and the part of a grasp; an empty name is an unnamed part."""

    kind: StepKind
    name: str
    role: Role
    part: str | None


class DemonstrationBody(HttpBody):
    """The input of a proposal; with `id` the behavior is also written as a new document."""

    steps: Annotated[tuple[DemonstrationStepBody, ...], Field(min_length=1, max_length=200)]
    arm: Annotated[str, Field(max_length=64)] = ""
    tool: ToolName | None = None
    speed: Annotated[float, Field(gt=0, le=1)] = 0.3
    line_speed_m_s: Annotated[float, Field(gt=0, le=1)] = 0.1
    approach_m: Annotated[float, Field(gt=0, le=0.5)] = 0.1
    width_m: Annotated[float, Field(ge=0, le=1)] | None = None
    id: Annotated[str, Field(max_length=300, pattern=r"^$|\.ya?ml$")] = ""


class ProposalBody(HttpBody):
    """The behavior as YAML, its description as text, and the choices made; `id` is the document it was written to."""

    text: str
    steps: tuple[ProposedStepBody, ...]
    words: tuple[str, ...]
    remarks: tuple[str, ...]
    arm: str
    tool: str
    arms: tuple[str, ...]
    parts: tuple[str, ...]
    findings: tuple[FindingBody, ...]
    id: str
