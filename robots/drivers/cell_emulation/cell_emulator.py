"""The emulator `cell`, as the entry point `flexcell.emulators` offers it, with its options."""

from __future__ import annotations

from typing import Annotated

from msgspec import Meta

from engine.cell.drivers import Emulator, EmulatorOptions


class CellEmulatorOptions(EmulatorOptions, frozen=True, kw_only=True):
    """Which cell, and where its side channel is; the devices are where the options of their drivers say."""

    file: Annotated[str, Meta(min_length=1, description="Cell document with the drivers")]
    seed: Annotated[
        int, Meta(ge=-1, description="Seed of the poses of parts and of the errors of arms; -1 for none")
    ] = -1
    host: Annotated[str, Meta(description="Loopback address of the side channel")] = "127.0.0.1"
    side_port: Annotated[int, Meta(ge=0, le=65535, description="TCP port of the side channel; 0 for a free one")] = 0


CELL_EMULATOR = Emulator(
    kind="cell",
    summary="All devices of a cell that have a driver, each by its own emulator, on one simulated world",
    options=CellEmulatorOptions,
    serve="robots.drivers.cell_emulation.serve_cell:serve_cell",
)
