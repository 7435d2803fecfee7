"""What goes between the event loop and the camera process."""

from __future__ import annotations

import msgspec

from robots.vision.known_geometry import KnownGeometry
from robots.vision.perception_messages import PerceptionRequest, PerceptionResult, PerceptionSetup


class StartPerception(msgspec.Struct, frozen=True, kw_only=True, tag="begin"):
    """Build the copy of the cell; the first message."""

    sight: PerceptionSetup


class UpdateKnownGeometry(msgspec.Struct, frozen=True, kw_only=True, tag="tell"):
    """Exclude these obstacles and held parts from the next image on."""

    known: KnownGeometry


class PerceptionOrder(msgspec.Struct, frozen=True, kw_only=True, tag="order"):
    """Look, and answer under this number."""

    number: int
    look: PerceptionRequest


class PerceptionReady(msgspec.Struct, frozen=True, kw_only=True, tag="opened"):
    """The copy stands and everything is compiled; `words` say how images are made."""

    words: str


class PerceptionAnswer(msgspec.Struct, frozen=True, kw_only=True, tag="answer"):
    """What was seen."""

    number: int
    seen: PerceptionResult


class PerceptionRefusal(msgspec.Struct, frozen=True, kw_only=True, tag="refused"):
    """The cell cannot be looked at, or this order could not be carried out; `number` is 0 for the cell."""

    message: str
    where: str = ""
    hint: str = ""
    number: int = 0


ToWorker = StartPerception | UpdateKnownGeometry | PerceptionOrder
FromWorker = PerceptionReady | PerceptionAnswer | PerceptionRefusal
