"""Makes the device of an arm on an ABB IRC5 from its options."""

from __future__ import annotations

from msgspec.structs import replace

from engine.cell.drivers import DeviceContext
from engine.clock import Clock
from robots.drivers.abb.abb_options import AbbOptions
from robots.drivers.abb.egm.new_egm_arm import new_egm_arm
from robots.drivers.abb.new_abb_irc5 import about_driver, new_abb_irc5
from robots.drivers.arm.arm_setup import arm_setup
from robots.drivers.arm.driven_arm import DrivenArm
from robots.io.wire.wire_capture import WireCapture


def new_abb_arm(options: AbbOptions, *, name: str, clock: Clock, context: DeviceContext) -> DrivenArm:
    """Return the arm, not yet connected.

    Raises:
        CellError: time is virtual, or the model is unknown or has more axes than the controller.
        DocumentError: a model folder or a calibration file is invalid.
    """
    setup = arm_setup(context, clock=clock)
    about, capture = about_driver(options, name=name), WireCapture(context.capture, device=name)
    if options.egm is not None:
        guided = new_egm_arm(
            options,
            options.egm,
            name=name,
            arm=setup.placement,
            about=replace(about, address=f"{options.host}, UDP port {options.egm.port}"),
            new_stop_line=context.new_stop_line,
            engine_silence_s=setup.engine_silence_s,
            capture=capture,
        )
        return DrivenArm(guided, setup=setup, clock=clock, about=about)
    connection = new_abb_irc5(
        options,
        name=name,
        clock=clock,
        model=setup.model,
        engine_silence_s=setup.engine_silence_s,
        capture=capture,
    )
    return DrivenArm(connection, setup=setup, clock=clock, about=about)
