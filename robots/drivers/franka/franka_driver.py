"""The driver `franka`, as the entry point `flexcell.drivers` offers it. Loads no client library."""

from __future__ import annotations

from engine.cell.drivers import Driver
from robots.drivers.franka.franka_options import FrankaOptions

FRANKA = Driver(
    kind="franka",
    drives="arm",
    models=frozenset({"fr3"}),
    options=FrankaOptions,
    capabilities=frozenset({"trajectory", "stream", "contact"}),
    missing_skills={
        "identify_friction": "the driver franka commands joint angles, not torques",
        "identify_payload": "the robot subtracts the load that it knows of; identify it in the web interface",
    },
    ports={"fci": 1337},
    proven=(
        "Never run on hardware. Tested with pylibfranka 0.21.3 against franky-sim 1.0.4, an FR3 of others in MuJoCo "
        "which judges no limits; reflexes and stops are made by a proxy of ours before it. FER (Panda) is refused."
    ),
    page="docs/how-to/connect-a-franka.md",
    device="robots.drivers.franka.new_franka:new_franka",
    enabling=(
        "Recovers from an error of the robot, sets thresholds, stiffness, end effector and load, "
        "and holds the arm where it is."
    ),
    not_captured="what `pylibfranka` opens itself (1337): use tcpdump on the network interface",
)
