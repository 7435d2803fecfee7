"""Makes the device of an arm whose controller has a control process."""

from __future__ import annotations

from collections.abc import Callable

import msgspec

from engine.cell.drivers import DeviceContext, DeviceReport, Driver, DriverOptions
from engine.clock import Clock
from engine.errors import CellError
from robots.drivers.arm.arm_process_messages import OpenController
from robots.drivers.arm.arm_setup import arm_setup
from robots.drivers.arm.driven_arm import DrivenArm
from robots.drivers.arm.process_arm_connection import ProcessArmConnection
from robots.port import Tolerance


def new_process_arm(
    driver: Driver,
    options: DriverOptions,
    *,
    controller: str,
    address: str,
    joints: int,
    stale_s: float,
    process_silence_s: float,
    clock: Clock,
    context: DeviceContext,
    tolerance: Tolerance | None = None,
    stop_past_process: Callable[[], object] = lambda: None,
    outputs: int | None = None,
) -> DrivenArm:
    """Return the arm, not yet connected.

    Args:
        driver: Its driver.
        options: Its options; the process receives them.
        controller: Where the process finds the maker of its `JointController`, `module:NAME`.
        address: Of the controller, for messages.
        joints: How many the driver drives.
        stale_s: Seconds without a new measurement until the arm counts as lost.
        process_silence_s: Seconds that its process may be silent until it is ended.
        clock: Real time.
        context: The surroundings.
        tolerance: How far the measured joints may be off the set point.
        outputs: Digital outputs of its controller; None for as many as the model has.
        stop_past_process: Stops the arm where its process is lost, see `ProcessArmConnection`.

    Raises:
        CellError: time is virtual, the model is unknown or has another number of joints.
        DocumentError: a model folder or a calibration file is invalid.
    """
    setup = arm_setup(context, clock=clock)
    if setup.model.dof != joints:
        hint = f"choose a `model` with {joints} joints"
        message = f"the driver {driver.kind} drives {joints} joints, and {setup.model.name} has {setup.model.dof}"
        raise CellError(message, where=context.robot, hint=hint)
    about = DeviceReport(
        device=context.robot,
        driver=driver.kind,
        address=address,
        capabilities=tuple(sorted(driver.capabilities)),
        proven=driver.proven,
    )
    request = OpenController(
        arm=setup.placement,
        controller=controller,
        options=msgspec.json.encode(options),
        stale_s=stale_s,
        engine_silence_s=setup.engine_silence_s,
        capture=str(context.capture) if context.capture is not None else "",
    )
    connection = ProcessArmConnection(
        request,
        model=setup.model,
        address=address,
        about=about,
        silence_s=process_silence_s,
        new_stop_line=context.new_stop_line,
        stop_past_process=stop_past_process,
        outputs=outputs,
    )
    return DrivenArm(connection, setup=setup, clock=clock, about=about, tolerance=tolerance)
