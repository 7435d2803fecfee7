"""The emulator `abb_irc5`, as the entry point `flexcell.emulators` offers it, with its options."""

from __future__ import annotations

from typing import Annotated

from msgspec import Meta

from engine.cell.drivers import Emulator, EmulatorOptions
from robots.drivers.abb.abb_options import AbbOptions
from robots.drivers.abb.rws.rws_options import RwsOptions
from robots.drivers.abb.simple_message import ByteOrder

Port = Annotated[int, Meta(ge=0, le=65535, description="TCP port; 0 for a free one")]

COMM_TIMEOUT_S = 0.2
# A driver that listens on any address of this computer also hears what is sent to this one.
_ANY_ADDRESS = "127.0.0.1"


class AbbEmulatorOptions(EmulatorOptions, frozen=True, kw_only=True):
    """Where the emulated controller listens, and what it is like."""

    host: Annotated[str, Meta(description="Loopback address to listen on")] = "127.0.0.1"
    motion_port: Port = 0
    state_port: Port = 0
    gripper_port: Port = 0
    rws_port: Port = 0
    rws_user: Annotated[str, Meta(description="User of Robot Web Services")] = "Default User"
    # The documented one of the user that every controller has.
    rws_password: Annotated[str, Meta(description="Its password")] = "robotics"  # noqa: S105
    signals: Annotated[str, Meta(description="Names of its digital inputs, with commas; all are off at first")] = ""
    egm_client: Annotated[str, Meta(description="HOST:PORT to which EGM sends; empty for no EGM")] = ""
    comm_timeout_s: Annotated[float, Meta(gt=0.0, le=10.0, description="CommTimeout of the EGM program")] = (
        COMM_TIMEOUT_S
    )
    side_port: Port = 0
    byte_order: Annotated[ByteOrder, Meta(description="little or big")] = "little"
    gripper_reply: Annotated[str, Meta(description="Reply to gripper texts; empty for none")] = ""
    stop_s: Annotated[float, Meta(gt=0.0, le=2.0, description="Seconds that StopMove takes at full speed")] = 0.2
    load_kg: Annotated[
        float, Meta(ge=0.0, le=60.0, description="Load of its tooldata, beside the tool, in an emulated cell")
    ] = 0.0
    joints_rad: Annotated[str, Meta(description="Angles of the six axes at the start, with commas")] = "0,0,0,0,0.5,0"


def emulator_options(driver: AbbOptions, _model: str) -> AbbEmulatorOptions:
    """Return the options of the controller that a driver is for.

    Its EGM program is as patient as the driver: in a slow world an answer may come late.

    Raises:
        CellError: its password is not known.
    """
    egm = driver.egm
    strings = driver.gripper
    reply = "ok" if strings is None or strings.reply in ("none", "any") else strings.reply
    rws = driver.rws or RwsOptions()
    return AbbEmulatorOptions(
        host=driver.host,
        motion_port=driver.motion_port,
        state_port=driver.state_port,
        gripper_port=strings.port if strings is not None else 0,
        byte_order=driver.byte_order,
        rws_port=rws.port if driver.rws is not None else 0,
        rws_user=rws.user,
        rws_password=rws.secret("rws"),
        signals=",".join(rws.inputs),
        egm_client=f"{egm.address or _ANY_ADDRESS}:{egm.port}" if egm is not None else "",
        comm_timeout_s=max(COMM_TIMEOUT_S, egm.stale_s) if egm is not None else COMM_TIMEOUT_S,
        gripper_reply="" if strings is None or strings.reply == "none" else reply,
    )


ABB_EMULATOR = Emulator(
    kind="abb_irc5",
    summary="ABB IRC5 with the programs of abb_driver: downloads, states, gripper texts, RWS, EGM",
    options=AbbEmulatorOptions,
    serve="robots.drivers.abb.emulation.serve_irc5:serve_irc5",
    for_driver="robots.drivers.abb.emulation.abb_emulator:emulator_options",
)
