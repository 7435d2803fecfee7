"""The emulator `universal_robots`, as the entry point `flexcell.emulators` offers it, with its options."""

from __future__ import annotations

from typing import Annotated, Literal

import msgspec
from msgspec import Meta

from engine.cell.drivers import Emulator, EmulatorOptions
from robots.drivers.universal_robots.ur_options import UrOptions


class UrEmulatorOptions(EmulatorOptions, frozen=True, kw_only=True):
    """Which controller is emulated, and where."""

    host: Annotated[str, Meta(description="Loopback address of its own: the ports of controllers are fixed")] = (
        "127.0.0.5"
    )
    model: Annotated[
        Literal["ur3", "ur5", "ur10", "ur3e", "ur5e", "ur10e"],
        Meta(description="Arm, one of ur3, ur5, ur10, ur3e, ur5e, ur10e"),
    ] = "ur10"
    series: Annotated[Literal["cb3", "e"], Meta(description="Controller: cb3 at 125 Hz, or e at 500 Hz")] = "cb3"
    tool_kg: Annotated[float, Meta(ge=0.0, le=20.0, description="Part of the payload that a world's tool weighs")] = 0.0


def emulator_options(driver: UrOptions, model: str) -> UrEmulatorOptions:
    """Return the options of the controller that a driver is for."""
    return msgspec.convert({"host": driver.host, "model": model, "tool_kg": driver.payload_kg}, UrEmulatorOptions)


UR_EMULATOR = Emulator(
    kind="universal_robots",
    summary="Universal Robots controller, CB3 or e-Series, that executes URScript; dynamics in an emulated cell only",
    options=UrEmulatorOptions,
    serve="robots.drivers.universal_robots.emulator.serve_controller:serve_controller",
    for_driver="robots.drivers.universal_robots.emulator.ur_emulator:emulator_options",
)
