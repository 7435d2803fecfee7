"""The messages between the event loop and the camera process: numbered requests, and what it is to know."""

from __future__ import annotations

import msgspec

from robots.io.request_failure import RequestFailure
from robots.vision.known_geometry import KnownGeometry
from robots.vision.perception_messages import PerceptionRequest, PerceptionResult, PerceptionSetup


class PerceptionReady(msgspec.Struct, frozen=True, kw_only=True, tag="ready"):
    """The answer to `PerceptionSetup`: the cell is copied and everything compiled; `words` names the rendering."""

    words: str


ToCameras = PerceptionSetup | KnownGeometry | PerceptionRequest
FromCameras = PerceptionReady | PerceptionResult | RequestFailure
