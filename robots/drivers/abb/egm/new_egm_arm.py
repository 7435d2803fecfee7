"""Makes the connection to an ABB controller that follows set points."""

from __future__ import annotations

from contextlib import suppress

import msgspec

from engine.cell.drivers import DeviceReport
from engine.errors import CellError
from robots.drivers.abb.abb_faults import AbbLinkError
from robots.drivers.abb.abb_options import AbbOptions
from robots.drivers.abb.egm.egm_arm_connection import EgmArmConnection
from robots.drivers.abb.egm.egm_controller import EgmProcessOptions
from robots.drivers.abb.egm.egm_messages import AXES
from robots.drivers.abb.egm.egm_options import EgmOptions
from robots.drivers.abb.gripper_switch import GripperSwitch
from robots.drivers.abb.rws.rws_client import RwsClient, RwsRefused
from robots.drivers.abb.rws.rws_monitor import RwsMonitor
from robots.drivers.abb.rws.rws_transport import EXECUTION
from robots.drivers.arm.arm_process_messages import OpenController
from robots.drivers.arm.process_arm_connection import NewStopLine, ProcessArmConnection
from robots.io.wire.wire_capture import NO_CAPTURE, WireCapture
from robots.io.wire.wire_tap import NO_TAP
from robots.port.heartbeat import ENGINE_SILENCE_S
from robots.scene.sim_scene import ArmPlacement

_CONTROLLER = "robots.drivers.abb.egm.egm_controller:new_egm_controller"


def new_egm_arm(
    options: AbbOptions,
    egm: EgmOptions,
    *,
    name: str,
    arm: ArmPlacement,
    about: DeviceReport,
    new_stop_line: NewStopLine | None = None,
    engine_silence_s: float = ENGINE_SILENCE_S,
    capture: WireCapture = NO_CAPTURE,
) -> EgmArmConnection:
    """Return the connection, not yet open.

    Raises:
        CellError: the model has another number of axes, or the password is not set.
    """
    model = arm.robot()
    if model.dof != AXES:
        raise CellError(
            f"{model.name} has {model.dof} joints, and guided motion has {AXES} axes",
            where=name,
            hint="external axes are not driven",
        )
    rws, password = options.rws, options.rws.secret(name) if options.rws is not None else ""
    stop_tap = capture.tap("rws_stop") if rws is not None else NO_TAP

    def stop_program() -> None:
        """Stop RAPID where the process of an arm that may move is lost; its CommTimeout stops it too."""
        if rws is None:
            return
        client = RwsClient(
            rws.host or options.host,
            rws.port,
            user=rws.user,
            password=password,
            timeout_s=min(1.0, rws.timeout_s),
            tap=stop_tap,
        )
        with suppress(AbbLinkError, RwsRefused):
            client.post(EXECUTION, "stop", {"stopmode": "stop"})
        client.close()

    given = EgmProcessOptions(
        host=options.host, egm=egm, matrix=model.joint_map.matrix, offset_rad=model.joint_map.offset_rad
    )
    process = ProcessArmConnection(
        OpenController(
            arm=arm,
            controller=_CONTROLLER,
            options=msgspec.json.encode(given),
            stale_s=egm.stale_s,
            engine_silence_s=engine_silence_s,
            capture=str(capture.folder) if capture.folder is not None else "",
        ),
        model=model,
        address=f"{options.host}, UDP port {egm.port}",
        about=about,
        silence_s=egm.process_silence_s,
        new_stop_line=new_stop_line,
        stop_past_process=stop_program,
        outputs=0,
    )
    gripper = options.gripper
    return EgmArmConnection(
        name,
        process,
        rws=(
            RwsMonitor(name, options.host, rws, password=password, tap=capture.tap("rws")) if rws is not None else None
        ),
        switch=(
            GripperSwitch(options.host, gripper, timeout_s=options.timeout_s, tap=capture.tap("gripper_text"))
            if gripper is not None
            else None
        ),
    )
