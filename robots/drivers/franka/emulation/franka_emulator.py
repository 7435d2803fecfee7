"""The emulator `franka`, as the entry point `flexcell.emulators` offers it, with its options."""

from __future__ import annotations

from typing import Annotated

from msgspec import Meta

from engine.cell.drivers import Emulator, EmulatorOptions


class FrankaEmulatorOptions(EmulatorOptions, frozen=True, kw_only=True):
    """Where the control cabinet is emulated, and how strict it is."""

    host: Annotated[str, Meta(description="Loopback address of its own: the ports of cabinets are fixed")] = "127.0.0.6"
    lost_packets: Annotated[
        int, Meta(ge=0, description="Set points lost in a row that end a motion: 20 of a robot, 0 for any number")
    ] = 0
    homed: Annotated[bool, Meta(description="Whether the hand knows its stroke from the start")] = True
    side_port: Annotated[int, Meta(ge=0, le=65535, description="TCP port of the side channel; 0 for a free one")] = 0


FRANKA_EMULATOR = Emulator(
    kind="franka",
    summary="Franka Research 3 with its hand: franky-sim in MuJoCo behind a proxy for faults; judges no limits",
    options=FrankaEmulatorOptions,
    serve="robots.drivers.franka.emulation.serve_franka:serve_franka",
)
