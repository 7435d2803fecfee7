"""Bodies for making and starting sweeps; what a sweep shows are structs of the engine."""

from __future__ import annotations

from typing import Annotated, Literal

import msgspec
from msgspec import Meta

from editor_web.http_bodies.common_bodies import RequestBody
from engine.document import SweepDocument


class NewSweepBody(RequestBody, frozen=True, kw_only=True):
    """A sweep document to be written to `id`, a path in the project; so are the paths in `document`."""

    id: Annotated[str, Meta(max_length=200)]
    document: SweepDocument


class SweepStartBody(RequestBody, frozen=True, kw_only=True):
    """A request to execute what is left of a sweep; `again` also what crashed or hung before."""

    again: bool = False


class ShrinkBody(RequestBody, frozen=True, kw_only=True):
    """A request to shrink a failing run; `same` is what must stay the same: how it ends, or its root cause too."""

    same: Literal["outcome", "cause"] = "outcome"


class SaveCaseBody(RequestBody, frozen=True, kw_only=True):
    """A request to save what a run was shrunk to as a test case: a sweep document at `id`, a path in the project."""

    id: Annotated[str, Meta(max_length=200)]


class SweepIdBody(msgspec.Struct, frozen=True, kw_only=True):
    """The sweep that was made."""

    id: str
