"""Makes the device of a Franka Hand from its options."""

from __future__ import annotations

from engine.cell.drivers import DeviceContext, DeviceReport
from engine.clock import Clock
from engine.errors import CellError
from robots.drivers.franka_hand.franka_hand import FrankaHand
from robots.drivers.franka_hand.franka_hand_driver import FRANKA_HAND
from robots.drivers.franka_hand.franka_hand_options import FrankaHandOptions
from robots.drivers.franka_hand.franka_hand_transport import FrankaHandTransport
from robots.drivers.tool_timing import tool_timing
from robots.io.wire.wire_capture import WireCapture


def new_franka_hand(options: FrankaHandOptions, *, name: str, clock: Clock, context: DeviceContext) -> FrankaHand:
    """Return the hand, not yet connected; raises CellError where time is virtual."""
    if clock.virtual:
        hint = "run it in real time: without `--clock virtual`; or simulate it with `driver: sim`"
        raise CellError("a real hand has no virtual time", where=name, hint=hint)
    capture = WireCapture(context.capture, device=name)
    transport = FrankaHandTransport(
        options.host,
        timeout_s=options.timeout_s,
        command_tap=capture.tap("hand_commands"),
        state_tap=capture.tap("hand_states"),
    )
    about = DeviceReport(
        device=name,
        driver=FRANKA_HAND.kind,
        address=transport.address,
        capabilities=tuple(sorted(FRANKA_HAND.capabilities)),
        proven=FRANKA_HAND.proven,
    )
    timing = tool_timing(context, period_s=options.period_s, stale_s=options.stale_s)
    return FrankaHand(name, transport, timing=timing, patience_s=options.patience_s, about=about)
