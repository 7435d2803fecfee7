"""The emulator `pigpiod`, as the entry point `flexcell.emulators` offers it, with its options."""

from __future__ import annotations

from engine.cell.drivers import Emulator
from robots.drivers.emulation.stream_options import StreamOptions


class PigpiodOptions(StreamOptions, frozen=True, kw_only=True):
    """Where the emulated pigpiod listens."""


PIGPIOD_EMULATOR = Emulator(
    kind="pigpiod",
    summary="pigpiod of a Raspberry Pi 3B: levels, modes and PWM of its pins, without notifications of edges",
    options=PigpiodOptions,
    serve="robots.drivers.equipment.emulation.serve_pigpiod:serve_pigpiod",
)
