"""Makes the device of a servo arm from its options."""

from __future__ import annotations

from engine.cell.drivers import DeviceContext, digital_outputs
from engine.clock import Clock
from robots.drivers.arm.driven_arm import DrivenArm
from robots.drivers.arm.new_process_arm import new_process_arm
from robots.drivers.servo_arm.servo_arm_driver import SERVO_ARM
from robots.drivers.servo_arm.servo_arm_options import ServoArmOptions
from robots.port import Tolerance


def new_servo_arm(options: ServoArmOptions, *, name: str, clock: Clock, context: DeviceContext) -> DrivenArm:
    """Return the arm, not yet connected; raises CellError, DocumentError as `new_process_arm`."""
    del name  # that of the arm in `context`
    return new_process_arm(
        SERVO_ARM,
        options,
        controller="robots.drivers.servo_arm.servo_arm_controller:new_servo_arm_controller",
        address=options.device,
        joints=len(options.servos),
        stale_s=options.stale_s,
        process_silence_s=options.process_silence_s,
        clock=clock,
        context=context,
        tolerance=Tolerance(path_rad=options.path_tolerance_rad),
        outputs=digital_outputs(context.cell, context.robot, of_model=0),
    )
