"""Makes the device of a SoftHand from its options."""

from __future__ import annotations

from itertools import pairwise

from engine.cell.drivers import DeviceContext, DeviceReport
from engine.clock import Clock
from engine.errors import CellError
from robots.drivers.softhand.softhand import SoftHand
from robots.drivers.softhand.softhand_driver import SOFTHAND
from robots.drivers.softhand.softhand_options import SoftHandOptions
from robots.drivers.softhand.softhand_port import HandCalibration
from robots.drivers.tool_timing import tool_timing
from robots.io.wire.wire_capture import WireCapture


def new_softhand(options: SoftHandOptions, *, name: str, clock: Clock, context: DeviceContext) -> SoftHand:
    """Return the hand, not yet connected.

    Raises:
        CellError: time is virtual, the calibration is none, or pyserial is missing.
    """
    if clock.virtual:
        hint = "run it in real time: without `--clock virtual`; or simulate it with `driver: sim`"
        raise CellError("a real hand has no virtual time", where=name, hint=hint)
    if not all(low[0] < high[0] for low, high in pairwise(options.free_ma)):
        hint = "write pairs of closed share and mA from open to closed"
        raise CellError("`free_ma` must have rising shares", where=name, hint=hint)
    if options.fault_ma <= options.current_limit_ma:
        hint = "a current limit ends a motion, a fault needs a person"
        raise CellError("`fault_ma` must be greater than `current_limit_ma`", where=name, hint=hint)
    try:
        from robots.drivers.softhand.hand_transport import HandTransport
    except ImportError as error:
        hint = "pip install 'flexcell[serial]'"
        raise CellError(f"the driver softhand needs a package: {error}", hint=hint) from error
    tap = WireCapture(context.capture, device=name).tap("softhand")
    transport = HandTransport(
        options.device, baud=options.baud, unit=options.unit, timeout_s=options.timeout_s, tap=tap
    )
    about = DeviceReport(
        device=name,
        driver=SOFTHAND.kind,
        address=transport.address,
        capabilities=tuple(sorted(SOFTHAND.capabilities)),
        proven=SOFTHAND.proven,
    )
    calibration = HandCalibration(
        closed_ticks=options.closed_ticks,
        stroke_s=options.stroke_s,
        free_ma=options.free_ma,
        current_limit_ma=options.current_limit_ma,
        fault_ma=options.fault_ma,
        force_n_ma=options.force_n_ma,
    )
    timing = tool_timing(context, period_s=options.period_s, stale_s=options.stale_s)
    return SoftHand(name, transport, timing=timing, calibration=calibration, about=about)
