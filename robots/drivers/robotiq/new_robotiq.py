"""Makes the device of a Robotiq gripper from its options."""

from __future__ import annotations

from itertools import pairwise

from engine.cell.drivers import DeviceContext, DeviceReport
from engine.clock import Clock
from engine.errors import CellError
from robots.drivers.device_transport import DeviceTransport
from robots.drivers.robotiq.gripper_registers import GripperCommand, GripperStatus
from robots.drivers.robotiq.robotiq_driver import ROBOTIQ
from robots.drivers.robotiq.robotiq_gripper import RobotiqGripper
from robots.drivers.robotiq.robotiq_options import RobotiqOptions, UrcapSocket
from robots.drivers.robotiq.urcap_transport import UrcapTransport
from robots.drivers.tool_timing import tool_timing
from robots.io.wire.wire_capture import WireCapture
from robots.io.wire.wire_tap import NO_TAP, WireTap


def new_robotiq(options: RobotiqOptions, *, name: str, clock: Clock, context: DeviceContext) -> RobotiqGripper:
    """Return the gripper, not yet connected.

    Raises:
        CellError: time is virtual, the table of openings is not one, or pymodbus is missing.
    """
    if clock.virtual:
        hint = "run it in real time: without `--clock virtual`; or simulate it with `driver: sim`"
        raise CellError("a real gripper has no virtual time", where=name, hint=hint)
    rising = all(low[0] < high[0] and low[1] > high[1] for low, high in pairwise(options.widths))
    if not rising:
        hint = "write pairs of counts and metres from open to closed"
        raise CellError("`widths` must have rising counts and falling openings", where=name, hint=hint)
    capture = WireCapture(context.capture, device=name)
    transport = new_transport(options, tap=capture.tap(options.protocol))
    about = DeviceReport(
        device=name,
        driver=ROBOTIQ.kind,
        address=transport.address,
        capabilities=tuple(sorted(ROBOTIQ.capabilities)),
        proven=ROBOTIQ.proven,
    )
    timing = tool_timing(context, period_s=options.period_s, stale_s=options.stale_s)
    return RobotiqGripper(
        name, transport, timing=timing, widths=options.widths, about=about, patience_s=options.patience_s
    )


def new_transport(options: RobotiqOptions, *, tap: WireTap = NO_TAP) -> DeviceTransport[GripperStatus, GripperCommand]:
    """Return the transport of a connection; raises CellError where a package is missing."""
    connection = options.connection
    if isinstance(connection, UrcapSocket):
        return UrcapTransport(connection, timeout_s=options.timeout_s, tap=tap)
    try:
        from robots.drivers.robotiq.modbus_transport import ModbusTransport
    except ImportError as error:
        hint = "pip install 'flexcell[robotiq]'"
        raise CellError(f"the driver robotiq needs a package: {error}", hint=hint) from error
    return ModbusTransport(connection, unit=options.unit, timeout_s=options.timeout_s, tap=tap)
