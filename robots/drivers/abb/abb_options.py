"""The options of the ABB driver: where the controller is, its ports and times, and how a path is downloaded."""

from __future__ import annotations

from typing import Annotated, Literal

from msgspec import Meta

from engine.cell.drivers import DriverOptions
from engine.document import StrictModel
from robots.drivers.abb.egm.egm_options import EgmOptions
from robots.drivers.abb.rws.rws_options import RwsOptions
from robots.drivers.abb.simple_message import ByteOrder

Port = Annotated[int, Meta(ge=1, le=65535, description="TCP port")]
SwitchText = Annotated[str, Meta(min_length=1, max_length=80, description="Text that is sent")]


class GripperStrings(StrictModel, frozen=True, kw_only=True):
    """A gripper that is switched by plain texts: output 0 of the arm.

    `reply` is `none`, `any`, or the exact text that confirms a switch, without white space around it.
    """

    port: Port = 11004
    on: SwitchText = "gripperON"
    off: SwitchText = "gripperOFF"
    end: Annotated[str, Meta(max_length=4, description="Sent after each text")] = ""
    reply: Annotated[str, Meta(min_length=1, max_length=80, description="none, any, or the exact text")] = "none"
    reply_s: Annotated[float, Meta(ge=0.01, le=10.0, description="Seconds until a reply counts as missing")] = 1.0


class AbbOptions(DriverOptions, frozen=True, kw_only=True, tag="abb_irc5"):
    """An ABB IRC5 with the server programs of abb_driver; axes are those of the model, with its `coupled_joints`."""

    host: Annotated[str, Meta(min_length=1, description="Address or name of the controller in the network")]
    motion_port: Port = 11000
    state_port: Port = 11002
    byte_order: Annotated[ByteOrder, Meta(description="little, as RAPID packs, or big")] = "little"
    gripper: GripperStrings | None = None
    rws: RwsOptions | None = None
    egm: EgmOptions | None = None
    loads: Annotated[
        Literal["refused", "defined_there"],
        Meta(
            description="Whether a load that a behavior sets is refused, or accepted without effect, because tool and "
            "load of the controller cover it"
        ),
    ] = "refused"
    timeout_s: Annotated[float, Meta(ge=0.05, le=5.0, description="Seconds until a reply counts as missing")] = 0.5
    stale_s: Annotated[
        float, Meta(ge=0.2, le=10.0, description="Seconds without a state message until the connection counts as lost")
    ] = 0.5
    patience_s: Annotated[
        float, Meta(ge=1.0, le=600.0, description="Seconds by which a motion may be late until it counts as failed")
    ] = 5.0
    min_duration_s: Annotated[float, Meta(ge=0.02, le=1.0, description="Shortest time between two points")] = 0.1
    max_deviation_rad: Annotated[
        float, Meta(gt=0.0, le=0.2, description="Largest deviation of the downloaded from the given path, each joint")
    ] = 0.01
