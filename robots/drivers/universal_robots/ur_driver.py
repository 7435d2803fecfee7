"""The driver `universal_robots`, as the entry point `flexcell.drivers` offers it. Loads no client library."""

from __future__ import annotations

from engine.cell.drivers import Driver
from robots.drivers.universal_robots.ur_options import UrOptions

UNIVERSAL_ROBOTS = Driver(
    kind="universal_robots",
    drives="arm",
    options=UrOptions,
    capabilities=frozenset({"trajectory", "stream", "contact", "outputs"}),
    missing_skills={
        "identify_friction": "the driver universal_robots measures no joint torques",
        "identify_payload": (
            "the driver universal_robots measures forces without the payload that its controller knows of; "
            "identify it at the teach pendant"
        ),
    },
    enabling=(
        "Uploads and starts the program that takes control of the arm, and sets tool, payload and watchdog. Releases "
        "no protective or emergency stop: that is done at the teach pendant."
    ),
    ports={"rtde": 30004, "dashboard": 29999, "script": 30003, "secondary": 30002},
    proven=(
        "Never run on hardware. Tested with the client library ur-rtde 1.6.5, and without it (`client: script`), "
        "against its emulator, CB3 at 125 Hz and e-Series at 500 Hz, which has no dynamics and no measured forces."
    ),
    page="docs/how-to/connect-a-universal-robot.md",
    device="robots.drivers.universal_robots.new_universal_robot:new_universal_robot",
    not_captured=(
        "RTDE (30004), the script (30003) and the dashboard connection of `ur-rtde`, which opens them itself: "
        "use `client: script`, or tcpdump on the network interface"
    ),
)
