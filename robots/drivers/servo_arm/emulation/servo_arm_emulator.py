"""The emulator `servo_arm`, as the entry point `flexcell.emulators` offers it, with its options."""

from __future__ import annotations

from typing import Annotated, Literal
from urllib.parse import urlsplit

from msgspec import Meta

from engine.cell.drivers import Emulator
from engine.errors import FlexcellError
from robots.drivers.emulation.stream_options import StreamOptions
from robots.drivers.servo_arm.servo_arm_options import ServoArmOptions

_WATCHDOG_S = 0.5


class ServoArmEmulatorOptions(StreamOptions, frozen=True, kw_only=True):
    """How the emulated board is connected, and what runs on it."""

    connection: Annotated[
        Literal["serial", "tcp"], Meta(description="Line, one of serial (a pty), tcp (a serial server)")
    ] = "serial"
    sketch: Annotated[Literal["flexcell", "bare"], Meta(description="What runs on the board: flexcell, bare")] = (
        "flexcell"
    )
    max_deg_s: Annotated[float, Meta(gt=0.0, le=1000.0, description="Greatest speed of a servo, degrees a second")] = (
        60.0
    )
    watchdog_s: Annotated[float, Meta(ge=0.0, le=10.0, description="Silence until it holds; 0 for never")] = _WATCHDOG_S
    boot_s: Annotated[float, Meta(ge=0.0, le=10.0, description="Seconds from a reset until it says READY")] = 0.1


def emulator_options(driver: ServoArmOptions, _model: str) -> ServoArmEmulatorOptions:
    """Return the options of the board that a driver is for.

    Raises:
        FlexcellError: it is connected by a serial line, whose name an emulator cannot choose.
    """
    address = urlsplit(driver.device)
    if address.scheme != "socket" or not address.hostname or not address.port:
        hint = "connect it by `device: socket://HOST:PORT`"
        raise FlexcellError(f"an emulated board cannot be at {driver.device}", where="device", hint=hint)
    return ServoArmEmulatorOptions(
        connection="tcp",
        host=address.hostname,
        port=address.port,
        sketch=driver.sketch,
        # Where the driver is given patience with a slow machine, the board needs it as well.
        watchdog_s=max(_WATCHDOG_S, driver.stale_s),
    )


SERVO_ARM_EMULATOR = Emulator(
    kind="servo_arm",
    summary="Servo arm on an Arduino with speed, watchdog, resets and faults; masses in an emulated cell only",
    options=ServoArmEmulatorOptions,
    serve="robots.drivers.servo_arm.emulation.serve_board:serve_board",
    for_driver="robots.drivers.servo_arm.emulation.servo_arm_emulator:emulator_options",
)
