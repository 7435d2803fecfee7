"""The driver `softhand`, as the entry point `flexcell.drivers` offers it. Loads neither pyserial nor the device."""

from __future__ import annotations

from engine.cell.drivers import Driver
from robots.drivers.softhand.softhand_options import SoftHandOptions

SOFTHAND = Driver(
    kind="softhand",
    drives="hand",
    models=frozenset({"softhand"}),
    options=SoftHandOptions,
    capabilities=frozenset({"hand"}),
    ports={},
    enabling="Switches the motor on at its present position, so that the hand does not move.",
    proven=(
        "Experimental, never run on hardware. Tested over pty and sockets against its own emulator only: "
        "no independent client or hand has confirmed the protocol."
    ),
    page="docs/how-to/connect-a-softhand.md",
    device="robots.drivers.softhand.new_softhand:new_softhand",
)
