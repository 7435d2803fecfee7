"""The options of an emulator that listens on a TCP port, and on another for its side channel."""

from __future__ import annotations

from typing import Annotated

from msgspec import Meta

from engine.cell.drivers import EmulatorOptions


class StreamOptions(EmulatorOptions, frozen=True, kw_only=True):
    """Where an emulator listens."""

    host: Annotated[str, Meta(description="Loopback address to listen on")] = "127.0.0.1"
    port: Annotated[int, Meta(ge=0, le=65535, description="TCP port; 0 for a free one")] = 0
    side_port: Annotated[int, Meta(ge=0, le=65535, description="TCP port of the side channel; 0 for a free one")] = 0
