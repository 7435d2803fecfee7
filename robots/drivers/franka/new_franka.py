"""Makes the device of a Franka arm from its options."""

from __future__ import annotations

from engine.cell.drivers import DeviceContext
from engine.clock import Clock
from robots.drivers.arm.driven_arm import DrivenArm
from robots.drivers.arm.new_process_arm import new_process_arm
from robots.drivers.franka.franka_driver import FRANKA
from robots.drivers.franka.franka_options import FrankaOptions
from robots.port import Tolerance

_JOINTS = 7


def new_franka(options: FrankaOptions, *, name: str, clock: Clock, context: DeviceContext) -> DrivenArm:
    """Return the arm, not yet connected; raises CellError, DocumentError as `new_process_arm`."""
    del name  # that of the arm in `context`
    return new_process_arm(
        FRANKA,
        options,
        controller="robots.drivers.franka.franka_joint_controller:new_franka_controller",
        address=options.host,
        joints=_JOINTS,
        stale_s=options.stale_s,
        process_silence_s=options.process_silence_s,
        clock=clock,
        context=context,
        tolerance=Tolerance(path_rad=options.path_tolerance_rad),
        outputs=0,
    )
