"""The emulator `softhand`, as the entry point `flexcell.emulators` offers it, with its options."""

from __future__ import annotations

from typing import Annotated, Literal

from msgspec import Meta

from engine.cell.drivers import Emulator
from robots.drivers.emulation.stream_options import StreamOptions


class SoftHandEmulatorOptions(StreamOptions, frozen=True, kw_only=True):
    """How the emulated hand is connected, and what is in it."""

    connection: Annotated[
        Literal["serial", "tcp"], Meta(description="Line, one of serial (a pty), tcp (a serial server)")
    ] = "serial"
    unit: Annotated[int, Meta(ge=1, le=255, description="Address of the hand")] = 1
    object_share: Annotated[
        float, Meta(ge=-1.0, le=1.0, description="Closed share at which an object blocks; -1 for nothing")
    ] = -1.0
    active: Annotated[bool, Meta(description="Whether its motor is on from the start")] = False


SOFTHAND_EMULATOR = Emulator(
    kind="softhand",
    summary="qb SoftHand with time, current, an object and faults; no physics behind its fingers",
    options=SoftHandEmulatorOptions,
    serve="robots.drivers.softhand.emulation.serve_hand:serve_hand",
)
