"""From demonstration to behavior: taught entries in their order become a new document."""

from __future__ import annotations

import msgspec
from fastapi import APIRouter
from starlette.concurrency import run_in_threadpool

from editor_web.http_bodies.common_bodies import ErrorBody, FindingBody
from editor_web.http_bodies.demonstration_bodies import DemonstrationBody, ProposalBody, ProposedStepBody
from editor_web.routes.document_route import DocumentRoute
from editor_web.routes.services import Services, ServicesOf
from engine.editing.cell_references import cell_reference
from engine.skills.proposing import Proposal, ProposalOptions, ProposeBehavior, TaughtStep

router = APIRouter(
    prefix="/api/v1/teach", tags=["teach"], route_class=DocumentRoute, responses={422: {"model": ErrorBody}}
)
UNNAMED = "behaviors/from_demonstration.yaml"


@router.post("/proposal")
async def propose_behavior(body: DemonstrationBody, services: ServicesOf) -> ProposalBody:
    """Propose the behavior that goes through taught entries; with an `id` write it as a new document."""
    request = await run_in_threadpool(_request, services, body)
    answer = await services.backend.bus.call(f"teach/{request.skill_name()}", msgspec.to_builtins(request))
    return await run_in_threadpool(_answer, services, body, msgspec.json.decode(answer, type=Proposal))


def _request(services: Services, body: DemonstrationBody) -> ProposeBehavior:
    file = services.documents.file_of(body.id or UNNAMED)
    options = ProposalOptions(
        name=file.stem[:80],
        arm=body.arm,
        tool=body.tool,
        speed=body.speed,
        line_speed_m_s=body.line_speed_m_s,
        approach_m=body.approach_m,
        width_m=body.width_m,
        cell=cell_reference(services.documents.project, cell=services.backend.cell_name, document=file),
    )
    steps = tuple(TaughtStep(kind=one.kind, name=one.name, role=one.role, part=one.part) for one in body.steps)
    return ProposeBehavior(steps=steps, options=options)


def _answer(services: Services, body: DemonstrationBody, made: Proposal) -> ProposalBody:
    if body.id:
        services.documents.add(body.id, made.text)
    examined = services.documents.examine(body.id or UNNAMED, made.text)
    return ProposalBody(
        text=made.text,
        steps=tuple(ProposedStepBody.model_validate(step) for step in made.steps),
        words=made.words,
        remarks=made.remarks,
        arm=made.arm,
        tool=made.tool,
        arms=made.arms,
        parts=made.parts,
        findings=tuple(FindingBody.model_validate(each) for each in examined.findings),
        id=body.id,
    )
