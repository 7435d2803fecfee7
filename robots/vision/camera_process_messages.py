"""The messages between the event loop and the camera process."""

from __future__ import annotations

import msgspec

from robots.vision.known_geometry import KnownGeometry
from robots.vision.perception_messages import PerceptionRequest, PerceptionResult, PerceptionSetup


class StartPerception(msgspec.Struct, frozen=True, kw_only=True, tag="begin"):
    """Build the copy of the cell; always the first message."""

    sight: PerceptionSetup


class UpdateKnownGeometry(msgspec.Struct, frozen=True, kw_only=True, tag="tell"):
    """Exclude these obstacles and held parts from the next image on."""

    known: KnownGeometry


class PerceptionOrder(msgspec.Struct, frozen=True, kw_only=True, tag="order"):
    """A perception request; the answer has the same number."""

    number: int
    look: PerceptionRequest


class PerceptionReady(msgspec.Struct, frozen=True, kw_only=True, tag="opened"):
    """The copy is built and everything is compiled; `words` names the rendering method."""

    words: str


class PerceptionAnswer(msgspec.Struct, frozen=True, kw_only=True, tag="answer"):
    """The result of a request."""

    number: int
    seen: PerceptionResult


class PerceptionRefusal(msgspec.Struct, frozen=True, kw_only=True, tag="refused"):
    """The cell cannot be rendered (`number` 0), or the request with this number failed."""

    message: str
    where: str = ""
    hint: str = ""
    number: int = 0


ToWorker = StartPerception | UpdateKnownGeometry | PerceptionOrder
FromWorker = PerceptionReady | PerceptionAnswer | PerceptionRefusal
