"""Makes the device of a Universal Robots arm from its options."""

from __future__ import annotations

from engine.cell.drivers import DeviceContext
from engine.clock import Clock
from robots.drivers.arm.driven_arm import DrivenArm
from robots.drivers.arm.new_process_arm import new_process_arm
from robots.drivers.universal_robots.ur_dashboard import ask_dashboard
from robots.drivers.universal_robots.ur_driver import UNIVERSAL_ROBOTS
from robots.drivers.universal_robots.ur_options import UrOptions
from robots.port import Tolerance

CONTROLLERS = {
    "ur_rtde": "robots.drivers.universal_robots.ur_joint_controller:new_ur_controller",
    "script": "robots.drivers.universal_robots.ur_script_controller:new_ur_script_controller",
}
"""Where the control process finds the maker of the controller of a client."""
_JOINTS = 6
_DASHBOARD_S = 0.3


def new_universal_robot(options: UrOptions, *, name: str, clock: Clock, context: DeviceContext) -> DrivenArm:
    """Return the arm, not yet connected; raises CellError, DocumentError as `new_process_arm`."""
    del name  # that of the arm in `context`
    return new_process_arm(
        UNIVERSAL_ROBOTS,
        options,
        controller=CONTROLLERS[options.client],
        address=options.host,
        joints=_JOINTS,
        stale_s=options.stale_s,
        process_silence_s=options.process_silence_s,
        clock=clock,
        context=context,
        tolerance=Tolerance(path_rad=options.path_tolerance_rad),
        stop_past_process=lambda: ask_dashboard(
            options.host, "stop", limit_s=_DASHBOARD_S, port=options.ports.dashboard
        ),
    )
