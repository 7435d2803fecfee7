"""The driver `servo_arm`: what it can do and what was proven. Loads neither pyserial nor the device."""

from __future__ import annotations

from engine.cell.drivers import Driver
from robots.drivers.servo_arm.servo_arm_options import ServoArmOptions

SERVO_ARM = Driver(
    kind="servo_arm",
    drives="arm",
    models=frozenset({"servo_arm"}),
    options=ServoArmOptions,
    capabilities=frozenset({"trajectory", "stream", "outputs"}),
    ports={},
    digital_outputs=lambda _options: 1,
    enabling=(
        "Sends GO, after which the board takes set points; with the sketch `bare` nothing is sent. Servos hold where "
        "they are. They have no stop of their own that could be released."
    ),
    proven=(
        "Never run on hardware. The sketch is compiled for this machine and compared with the emulator line by line; "
        "the driver is tested over pty and sockets with the emulator. Its servos report no position."
    ),
    page="docs/how-to/connect-a-servo-arm.md",
    device="robots.drivers.servo_arm.new_servo_arm:new_servo_arm",
)
