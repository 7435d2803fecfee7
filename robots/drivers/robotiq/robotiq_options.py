"""The options of the Robotiq driver: how the gripper is connected, and its times."""

from __future__ import annotations

from typing import Annotated

from msgspec import Meta

from engine.cell.drivers import DriverOptions
from engine.document import StrictModel

Host = Annotated[str, Meta(min_length=1, description="Address or name of the device in the network")]
Port = Annotated[int, Meta(ge=1, le=65535, description="TCP port")]


class SerialLine(StrictModel, frozen=True, kw_only=True, tag_field="kind", tag="serial"):
    """Modbus RTU over a serial line: a USB-RS485 converter."""

    device: Annotated[str, Meta(min_length=1, description="Serial device, such as `/dev/ttyUSB0`")]
    baud: Annotated[int, Meta(gt=0, description="Baud rate; 115200 unless the gripper was configured otherwise")] = (
        115200
    )


class RtuOverTcp(StrictModel, frozen=True, kw_only=True, tag_field="kind", tag="rtu_over_tcp"):
    """Modbus RTU frames through a TCP socket: the tool connector of a UR arm, or a converter."""

    host: Host
    port: Port = 54321


class ModbusTcp(StrictModel, frozen=True, kw_only=True, tag_field="kind", tag="modbus_tcp"):
    """Modbus TCP: the universal controller of Robotiq."""

    host: Host
    port: Port = 502


class UrcapSocket(StrictModel, frozen=True, kw_only=True, tag_field="kind", tag="urcap"):
    """The text server that the Robotiq URCap opens on a UR controller."""

    host: Host
    port: Port = 63352


RobotiqConnection = SerialLine | RtuOverTcp | ModbusTcp | UrcapSocket

Count = Annotated[int, Meta(ge=0, le=255, description="Measured position in counts, 0 open to 255 closed")]
Opening = Annotated[float, Meta(ge=0.0, le=0.2, description="Opening between the pads in metres")]


class RobotiqOptions(DriverOptions, frozen=True, kw_only=True, tag="robotiq"):
    """A Robotiq 2F-85.

    `widths` are at least two pairs of measured position and opening, from open to closed: measure some to correct what
    the linkage does between its ends.
    """

    connection: RobotiqConnection
    unit: Annotated[int, Meta(ge=1, le=247, description="Modbus address of the gripper")] = 9
    widths: Annotated[tuple[tuple[Count, Opening], ...], Meta(min_length=2)] = ((3, 0.085), (230, 0.0))
    period_s: Annotated[float, Meta(ge=0.005, le=0.2, description="Seconds between two readings")] = 0.02
    timeout_s: Annotated[float, Meta(ge=0.02, le=2.0, description="Seconds until a request counts as lost")] = 0.2
    stale_s: Annotated[
        float, Meta(ge=0.1, le=10.0, description="Seconds without a reading until the connection counts as lost")
    ] = 0.5
    patience_s: Annotated[
        float, Meta(ge=1.0, le=600.0, description="Seconds by which a motion of the fingers may be late until it fails")
    ] = 2.0

    @property
    def protocol(self) -> str:
        """What is spoken on the connection."""
        match self.connection:
            case SerialLine():
                return "modbus_rtu"
            case RtuOverTcp():
                return "rtu_over_tcp"
            case ModbusTcp():
                return "modbus_tcp"
            case UrcapSocket():
                return "urcap"
