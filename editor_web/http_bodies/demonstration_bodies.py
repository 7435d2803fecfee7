"""Bodies for a behavior proposed from taught entries."""

from __future__ import annotations

from typing import Annotated

from msgspec import Meta

from engine.library import FindingView
from engine.skills.proposing import Proposal, ProposeBehavior


class DemonstrationBody(ProposeBehavior, frozen=True, kw_only=True):
    """The request for a proposal; with `id` the behavior is also written as a new document.

    The server fills in `name` and `cell` of the options.
    """

    id: Annotated[str, Meta(max_length=300, pattern=r"^$|\.ya?ml$")] = ""


class ProposalBody(Proposal, frozen=True, kw_only=True):
    """A proposal with the findings of its behavior; `id` is the document it was written to, empty for none."""

    findings: tuple[FindingView, ...]
    id: str
