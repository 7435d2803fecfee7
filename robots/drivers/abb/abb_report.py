"""What a report says of a controller, from its state messages and Robot Web Services."""

from __future__ import annotations

from collections.abc import Sequence
from statistics import median

from msgspec.structs import replace

from engine.cell.drivers import DeviceReport
from robots.drivers.abb.abb_faults import AbbFault, status_fault
from robots.drivers.abb.rws.rws_monitor import RwsMonitor
from robots.drivers.abb.simple_message import RobotStatus
from robots.drivers.abb.state_transport import AbbReading
from robots.drivers.arm.arm_connection import NORMAL
from robots.drivers.fresh_link import FreshReading

Cause = tuple[AbbFault, str]


def abb_report(
    about: DeviceReport, collected: Sequence[FreshReading[AbbReading]], *, rws: RwsMonitor | None
) -> DeviceReport:
    """Return what the last of these readings says, at least one, and how often they came."""
    reading = collected[-1].value
    fault = cause_of(reading.status, rws)
    axes = {f"axis_{number}_rad": angle for number, angle in enumerate(reading.joints_rad[:6], start=1)}
    speed = {"speed_ratio": rws.speed_share} if rws is not None and rws.speed_share is not None else {}
    return replace(
        about,
        state=_state_text(reading.status, rws),
        fault=f"{fault[0].value}: {fault[1]}" if fault is not None else "",
        firmware=rws.firmware if rws is not None else "",
        inputs=rws.input_values if rws is not None else (),
        readings={**axes, "state_interval_s": median(each.took_s for each in collected), **speed},
    )


def cause_of(status: RobotStatus, rws: RwsMonitor | None) -> Cause | None:
    """Return why the controller does not move; None if it can.

    Robot Web Services name it more precisely, but are asked less often: an emergency stop in the status is newer.
    """
    fault = status_fault(status)
    named = rws.fault if rws is not None else None
    is_stop = fault is not None and fault[0] is AbbFault.EMERGENCY_STOP
    return fault if named is None or (is_stop and named[0] is not AbbFault.EMERGENCY_STOP) else named


def safety_text(status: RobotStatus, rws: RwsMonitor | None) -> str:
    """Return why the controller does not move, by name; `normal` while it can."""
    fault = cause_of(status, rws)
    safety = NORMAL if fault is None else f"{fault[0].value}: {fault[1]}"
    return f"{safety} (RWS is lost: {rws.lost_reason})" if rws is not None and rws.lost_reason else safety


def _state_text(status: RobotStatus, rws: RwsMonitor | None) -> str:
    safety = safety_text(status, rws)
    can = safety.replace(NORMAL, "ready", 1) if safety.startswith(NORMAL) else safety
    state = rws.state if rws is not None else None
    mode = state.mode if state is not None else status.mode.name.lower()
    program = f", RAPID {state.execution}" if state is not None else ""
    return f"{can}, {mode} mode, {'in motion' if status.in_motion else 'at rest'}{program}"


def fault_named(reason: str) -> AbbFault:
    """Return the fault whose name is in a reason."""
    return next((fault for fault in AbbFault if fault.value in reason), AbbFault.LINK_CUT)
