"""Bodies for adapting a behavior of another cell to the open one."""

from __future__ import annotations

from typing import Annotated

import msgspec
from msgspec import Meta

from editor_web.http_bodies.common_bodies import Name, RequestBody
from editor_web.http_bodies.document_bodies import Id
from engine.editing import AdaptationPlan


class AdaptationRequest(RequestBody, frozen=True, kw_only=True):
    """What names of the behavior become, by `kind:name`, an empty one to keep it; others are proposed.

    `id` is that of the new document, one beside the original if empty; `name` that of the new behavior.
    """

    id: Id = ""
    name: Annotated[str, Meta(max_length=128)] = ""
    names: dict[Name, Name] = {}


class AdaptationBody(msgspec.Struct, frozen=True, kw_only=True):
    """What would be written: the id and name of the new document, its plan, and the ids of copies of nested ones."""

    id: str
    name: str
    plan: AdaptationPlan
    copies: tuple[str, ...]
