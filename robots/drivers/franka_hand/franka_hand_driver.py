"""The driver `franka_hand`, as the entry point `flexcell.drivers` offers it. Connects to nothing."""

from __future__ import annotations

from engine.cell.drivers import Driver
from robots.drivers.franka_hand.franka_hand_options import FrankaHandOptions

FRANKA_HAND = Driver(
    kind="franka_hand",
    drives="gripper",
    models=frozenset({"panda_hand"}),
    options=FrankaHandOptions,
    capabilities=frozenset({"gripper"}),
    ports={"hand": 1338},
    proven=(
        "Never run on hardware. Tested with the hand of franky-sim 1.0.4, which others have written; the requests are "
        "byte for byte those of libfranka 0.21.3."
    ),
    page="docs/how-to/connect-a-franka.md",
    enabling=(
        "Homes a hand that was switched on: its fingers open and close, and drop what they hold. "
        "A homed hand does not move."
    ),
    device="robots.drivers.franka_hand.new_franka_hand:new_franka_hand",
)
