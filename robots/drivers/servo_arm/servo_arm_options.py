"""The options of the driver `servo_arm`, as a cell document writes them."""

from __future__ import annotations

from typing import Annotated, Literal

from msgspec import Meta

from engine.cell.drivers import DriverOptions
from engine.document import StrictModel

Degrees = Annotated[float, Meta(ge=-360.0, le=360.0)]


class ServoCalibration(StrictModel, frozen=True, kw_only=True):
    """One joint and its servo: servo angle = `scale` · joint angle + `offset_deg`, between `lower_deg` and `upper_deg`.

    `home_deg` is the servo angle at which the board holds the servo when it is enabled after a start.
    """

    scale: Annotated[float, Meta(ge=-10.0, le=10.0, description="Turn of the servo for a turn of the joint")] = 1.0
    offset_deg: Degrees = 0.0
    lower_deg: Degrees = 0.0
    upper_deg: Degrees = 180.0
    home_deg: Degrees = 0.0


class ServoArmOptions(DriverOptions, frozen=True, kw_only=True, tag="servo_arm"):
    """A servo arm on an Arduino.

    With the sketch `flexcell` the board answers each line, limits the speed of its servos and stops without lines. With
    `bare` it answers nothing: whole degrees are sent, and nothing tells whether anything has arrived.
    """

    device: Annotated[
        str, Meta(min_length=1, description="Serial device, such as `/dev/ttyACM0`, or `socket://host:port`")
    ]
    baud: Annotated[int, Meta(gt=0, description="Baud rate of the sketch")] = 115200
    sketch: Annotated[Literal["flexcell", "bare"], Meta(description="What runs on the board")] = "flexcell"
    servos: Annotated[tuple[ServoCalibration, ...], Meta(min_length=1, max_length=8)] = (
        ServoCalibration(),
        ServoCalibration(offset_deg=150.0, home_deg=160.0),
    )
    period_s: Annotated[float, Meta(ge=0.01, le=0.2, description="Seconds between two set points")] = 0.02
    boot_s: Annotated[
        float, Meta(ge=0.0, le=10.0, description="Seconds that the board may take to start: opening the line resets it")
    ] = 2.0
    stale_s: Annotated[
        float, Meta(ge=0.1, le=10.0, description="Seconds without an answer until the connection counts as lost")
    ] = 0.5
    path_tolerance_rad: Annotated[
        float, Meta(gt=0.0, le=1.0, description="How far a joint may be behind its set point")
    ] = 0.15
    process_silence_s: Annotated[
        float, Meta(ge=0.1, le=10.0, description="Seconds that its process may be silent until it is ended")
    ] = 1.0
