"""The emulator `robotiq`, as the entry point `flexcell.emulators` offers it, with its options."""

from __future__ import annotations

from typing import Annotated, Literal

from msgspec import Meta

from engine.cell.drivers import Emulator
from engine.errors import FlexcellError
from robots.drivers.emulation.stream_options import StreamOptions
from robots.drivers.robotiq.robotiq_options import ModbusTcp, RobotiqOptions, RtuOverTcp, SerialLine, UrcapSocket


class RobotiqEmulatorOptions(StreamOptions, frozen=True, kw_only=True):
    """How the emulated gripper is connected, and what is between its fingers."""

    connection: Annotated[
        Literal["serial", "rtu_over_tcp", "modbus_tcp", "urcap"],
        Meta(description="Protocol, one of serial (a pty), rtu_over_tcp, modbus_tcp, urcap"),
    ] = "modbus_tcp"
    unit: Annotated[int, Meta(ge=1, le=247, description="Modbus address")] = 9
    object_m: Annotated[float, Meta(ge=-1.0, le=0.085, description="Width between the fingers; -1 for nothing")] = -1.0
    activation_s: Annotated[float, Meta(ge=0.0, le=10.0, description="Seconds that an activation takes")] = 1.0
    active: Annotated[bool, Meta(description="Whether it is activated from the start")] = False


def emulator_options(driver: RobotiqOptions, _model: str) -> RobotiqEmulatorOptions:
    """Return the options of the gripper that a driver is for.

    Raises:
        FlexcellError: it is connected by a serial line, whose name an emulator cannot choose.
    """
    connection = driver.connection
    if isinstance(connection, SerialLine):
        raise FlexcellError(
            f"an emulated gripper cannot be at {connection.device}",
            where="connection",
            hint="connect it by `rtu_over_tcp`, `modbus_tcp` or `urcap`",
        )
    return RobotiqEmulatorOptions(
        host=connection.host, port=connection.port, unit=driver.unit, connection=_CONNECTIONS[type(connection)]
    )


_CONNECTIONS: dict[type[object], Literal["rtu_over_tcp", "modbus_tcp", "urcap"]] = {
    RtuOverTcp: "rtu_over_tcp",
    ModbusTcp: "modbus_tcp",
    UrcapSocket: "urcap",
}

ROBOTIQ_EMULATOR = Emulator(
    kind="robotiq",
    summary="Robotiq 2F-85 with time, speed, objects and faults; physics in an emulated cell only",
    options=RobotiqEmulatorOptions,
    serve="robots.drivers.robotiq.emulation.serve_gripper:serve_gripper",
    for_driver="robots.drivers.robotiq.emulation.robotiq_emulator:emulator_options",
)
