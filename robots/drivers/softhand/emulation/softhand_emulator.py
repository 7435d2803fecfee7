"""The emulator `softhand`, as the entry point `flexcell.emulators` offers it, with its options."""

from __future__ import annotations

from typing import Annotated, Literal
from urllib.parse import urlsplit

from msgspec import Meta

from engine.cell.drivers import Emulator
from engine.errors import FlexcellError
from robots.drivers.emulation.stream_options import StreamOptions
from robots.drivers.softhand.softhand_options import SoftHandOptions


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


def emulator_options(driver: SoftHandOptions, _model: str) -> SoftHandEmulatorOptions:
    """Return the options of the hand that a driver is for.

    Raises:
        FlexcellError: it is connected by a serial line, whose name an emulator cannot choose.
    """
    address = urlsplit(driver.device)
    if address.scheme != "socket" or not address.hostname or not address.port:
        hint = "connect it by `device: socket://HOST:PORT`"
        raise FlexcellError(f"an emulated hand cannot be at {driver.device}", where="device", hint=hint)
    return SoftHandEmulatorOptions(connection="tcp", host=address.hostname, port=address.port, unit=driver.unit)


SOFTHAND_EMULATOR = Emulator(
    kind="softhand",
    summary="qb SoftHand with time, current, an object and faults; physics in an emulated cell only",
    options=SoftHandEmulatorOptions,
    serve="robots.drivers.softhand.emulation.serve_hand:serve_hand",
    for_driver="robots.drivers.softhand.emulation.softhand_emulator:emulator_options",
)
