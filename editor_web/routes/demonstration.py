"""Programming by demonstration: proposes a behavior from an ordered list of taught entries."""

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
    """Propose a behavior that executes taught entries in order; with an `id`, write it as a new document."""
    request = await run_in_threadpool(_request, services, body)
    answer = await services.backend.bus.call(f"teach/{request.skill_name()}", msgspec.to_builtins(request))
    return await run_in_threadpool(_response, services, body, msgspec.json.decode(answer, type=Proposal))


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


def _response(services: Services, body: DemonstrationBody, proposal: Proposal) -> ProposalBody:
    if body.id:
        services.documents.add(body.id, proposal.text)
    analysis = services.documents.examine(body.id or UNNAMED, proposal.text)
    return ProposalBody(
        text=proposal.text,
        steps=tuple(ProposedStepBody.model_validate(step) for step in proposal.steps),
        words=proposal.words,
        remarks=proposal.remarks,
        arm=proposal.arm,
        tool=proposal.tool,
        arms=proposal.arms,
        parts=proposal.parts,
        findings=tuple(FindingBody.model_validate(each) for each in analysis.findings),
        id=body.id,
    )
