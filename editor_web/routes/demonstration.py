"""Programming by demonstration: proposes a behavior from an ordered list of taught entries."""

from __future__ import annotations

import msgspec
from msgspec.structs import asdict, replace
from starlette.concurrency import run_in_threadpool

from editor_web.http_bodies.common_bodies import ErrorBody
from editor_web.http_bodies.demonstration_bodies import DemonstrationBody, ProposalBody
from editor_web.routes.services import Services, ServicesOf
from editor_web.routes.wire_router import WireRouter
from engine.editing import cell_reference
from engine.skills.proposing import Proposal, ProposeBehavior

router = WireRouter(prefix="/api/v1/teach", tags=["teach"], responses={422: {"model": ErrorBody}})
UNNAMED = "behaviors/from_demonstration.yaml"


@router.post("/proposal")
async def propose_behavior(body: DemonstrationBody, services: ServicesOf) -> ProposalBody:
    """Propose a behavior that executes taught entries in order; with an `id`, write it as a new document."""
    request = await run_in_threadpool(_request, services, body)
    answer = await services.backend.bus.call(f"teach/{request.skill_name()}", msgspec.to_builtins(request))
    return await run_in_threadpool(_response, services, body, msgspec.json.decode(answer, type=Proposal))


def _request(services: Services, body: DemonstrationBody) -> ProposeBehavior:
    file = services.documents.file_of(body.id or UNNAMED)
    cell = cell_reference(services.documents.project, cell=services.backend.cell_name, document=file)
    options = replace(body.options, name=file.stem[:80], cell=cell)
    return ProposeBehavior(steps=body.steps, options=options)


def _response(services: Services, body: DemonstrationBody, proposal: Proposal) -> ProposalBody:
    if body.id:
        services.documents.add(body.id, proposal.text)
    analysis = services.documents.examine(body.id or UNNAMED, proposal.text)
    return ProposalBody(**asdict(proposal), findings=analysis.findings, id=body.id)
