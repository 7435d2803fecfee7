"""Makes the connection to an ABB IRC5 from its options and the model of its arm."""

from __future__ import annotations

from engine.cell.drivers import DeviceReport
from engine.clock import Clock
from engine.errors import CellError
from robots.drivers.abb.abb_connection import AbbConnection
from robots.drivers.abb.abb_driver import ABB_IRC5
from robots.drivers.abb.abb_options import AbbOptions
from robots.drivers.abb.rws.rws_monitor import RwsMonitor
from robots.io.wire.wire_capture import NO_CAPTURE, WireCapture
from robots.model.robot_model import RobotModel
from robots.port.heartbeat import ENGINE_SILENCE_S

_AXES = 6


def new_abb_irc5(
    options: AbbOptions,
    *,
    name: str,
    clock: Clock,
    model: RobotModel,
    engine_silence_s: float = ENGINE_SILENCE_S,
    capture: WireCapture = NO_CAPTURE,
) -> AbbConnection:
    """Return the connection, not yet open; `coupled_joints` of the cell is in the model.

    Raises:
        CellError: time is virtual, the model has more axes than the controller, or the password is not set.
    """
    if clock.virtual:
        hint = "run it in real time: without `--clock virtual`; or simulate it with `driver: sim`"
        raise CellError("a real arm has no virtual time", where=name, hint=hint)
    if len(model.arm_joints) > _AXES:
        raise CellError(
            f"{model.name} has {len(model.arm_joints)} joints, and the driver {ABB_IRC5.kind} drives {_AXES} axes",
            where=name,
            hint="external axes are not driven",
        )
    rws = options.rws
    return AbbConnection(
        name,
        options,
        joint_names=model.arm_joints,
        joint_map=model.joint_map,
        about=about_driver(options, name=name),
        engine_silence_s=engine_silence_s,
        capture=capture,
        rws=(
            RwsMonitor(name, options.host, rws, password=rws.secret(name), tap=capture.tap("rws"))
            if rws is not None
            else None
        ),
    )


def about_driver(options: AbbOptions, *, name: str) -> DeviceReport:
    """Return what a report says of the driver, without the device."""
    return DeviceReport(
        device=name,
        driver=ABB_IRC5.kind,
        address=f"{options.host}:{options.state_port}",
        capabilities=tuple(sorted(ABB_IRC5.configured(options).capabilities)),
        proven=ABB_IRC5.proven,
    )
