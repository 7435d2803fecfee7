"""The emulator `robotiq`, as the entry point `flexcell.emulators` offers it, with its options."""

from __future__ import annotations

from typing import Annotated, Literal

from msgspec import Meta

from engine.cell.drivers import Emulator, EmulatorOptions


class RobotiqEmulatorOptions(EmulatorOptions, frozen=True, kw_only=True):
    """How the emulated gripper is connected, and what is between its fingers."""

    connection: Annotated[
        Literal["serial", "rtu_over_tcp", "modbus_tcp", "urcap"],
        Meta(description="Protocol, one of serial (a pty), rtu_over_tcp, modbus_tcp, urcap"),
    ] = "modbus_tcp"
    host: Annotated[str, Meta(description="Loopback address to listen on")] = "127.0.0.1"
    port: Annotated[int, Meta(ge=0, le=65535, description="TCP port; 0 for a free one")] = 0
    side_port: Annotated[int, Meta(ge=0, le=65535, description="TCP port of the side channel; 0 for a free one")] = 0
    unit: Annotated[int, Meta(ge=1, le=247, description="Modbus address")] = 9
    object_m: Annotated[float, Meta(ge=-1.0, le=0.085, description="Width between the fingers; -1 for nothing")] = -1.0
    activation_s: Annotated[float, Meta(ge=0.0, le=10.0, description="Seconds that an activation takes")] = 1.0
    active: Annotated[bool, Meta(description="Whether it is activated from the start")] = False


ROBOTIQ_EMULATOR = Emulator(
    kind="robotiq",
    summary="Robotiq 2F-85 with time, speed, objects and faults; no physics behind its fingers",
    options=RobotiqEmulatorOptions,
    serve="robots.drivers.robotiq.emulation.serve_gripper:serve_gripper",
)
