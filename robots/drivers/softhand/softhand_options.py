"""The options of the SoftHand driver: its serial line, its calibration, and its times."""

from __future__ import annotations

from typing import Annotated, Literal

from msgspec import Meta

from engine.cell.drivers import DriverOptions

ClosedShare = Annotated[float, Meta(ge=0.0, le=1.0, description="Closed share, 0 open to 1 closed")]
Current = Annotated[float, Meta(ge=0.0, le=5000.0, description="Motor current in mA")]


class SoftHandOptions(DriverOptions, frozen=True, kw_only=True, tag="softhand"):
    """A qb SoftHand Research.

    `free_ma` are at least two pairs of closed share and motor current for closing on nothing, from open to closed:
    measure them, the defaults are estimates. `force_n_ma` is one too. With `stale_s` over four times `timeout_s` one
    answer may get lost: after it the line has to be quiet for twice `timeout_s`.
    """

    device: Annotated[
        str, Meta(min_length=1, description="Serial device, such as `/dev/ttyUSB0`, or `socket://host:port`")
    ]
    baud: Annotated[Literal[2000000, 460800], Meta(description="Baud rate of the hand")] = 2000000
    unit: Annotated[int, Meta(ge=1, le=255, description="Address of the hand")] = 1
    closed_ticks: Annotated[int, Meta(ge=1000, le=32767, description="Position of the closed hand")] = 19000
    stroke_s: Annotated[float, Meta(gt=0.0, le=10.0, description="Shortest time from open to closed, seconds")] = 1.0
    free_ma: Annotated[tuple[tuple[ClosedShare, Current], ...], Meta(min_length=2)] = ((0.0, 60.0), (1.0, 260.0))
    current_limit_ma: Annotated[
        float, Meta(gt=0.0, le=1500.0, description="Motor current at which closing ends: the greatest pull")
    ] = 750.0
    fault_ma: Annotated[float, Meta(gt=0.0, le=5000.0, description="Motor current that is a fault")] = 1500.0
    force_n_ma: Annotated[float, Meta(gt=0.0, le=10.0, description="Pull of the motor for each mA, newton")] = 0.2
    period_s: Annotated[float, Meta(ge=0.005, le=0.2, description="Seconds between two readings")] = 0.02
    timeout_s: Annotated[float, Meta(ge=0.02, le=2.0, description="Seconds until a request counts as lost")] = 0.2
    stale_s: Annotated[
        float, Meta(ge=0.1, le=10.0, description="Seconds without a reading until the connection counts as lost")
    ] = 1.0
