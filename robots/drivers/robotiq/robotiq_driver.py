"""The driver `robotiq`, as the entry point `flexcell.drivers` offers it. Loads neither pymodbus nor the device."""

from __future__ import annotations

from engine.cell.drivers import Driver
from robots.drivers.robotiq.robotiq_options import RobotiqOptions

ROBOTIQ = Driver(
    kind="robotiq",
    drives="gripper",
    models=frozenset({"robotiq_2f85"}),
    options=RobotiqOptions,
    capabilities=frozenset({"gripper"}),
    enabling=(
        "Activates the gripper where it is not active, which resets its fault, opens and closes the fingers, and drops "
        "what they hold. A gripper that is active stays as it is."
    ),
    ports={"rtu_over_tcp": 54321, "modbus_tcp": 502, "urcap": 63352},
    proven=(
        "Never run on hardware. Tested over pty and sockets against its emulator, which the foreign client "
        "pyrobotiqgripper drives too; frames compared with those of the manual."
    ),
    page="docs/how-to/connect-a-robotiq-gripper.md",
    device="robots.drivers.robotiq.new_robotiq:new_robotiq",
)
