"""The options of the driver `universal_robots`, as a cell document writes them."""

from __future__ import annotations

from typing import Annotated, Literal

from msgspec import Meta

from engine.cell.drivers import DriverOptions
from engine.document import StrictModel

Metres = Annotated[float, Meta(ge=-2.0, le=2.0)]
Radians = Annotated[float, Meta(ge=-6.3, le=6.3)]


DASHBOARD_S, PROGRAM_END_S = 0.12, 0.3
"""How long a control process waits for an answer of the dashboard, and for the end of its program."""
LONGEST_SILENCE_S = 0.6
"""A set point that is refused has the cause asked for, then the program asked to end, then the dashboard to stop."""

LONGEST_START_S = 12.0
"""A command of the library may take 4 s more until it gives up; whoever enables the arm waits for 20 s."""
Port = Annotated[int, Meta(ge=1, le=65535)]


class UrPorts(StrictModel, frozen=True, kw_only=True):
    """Where the controller listens; `ur-rtde` has these numbers built in."""

    rtde: Port = 30004
    dashboard: Port = 29999
    script: Annotated[Port, Meta(description="Secondary or primary interface; both execute programs")] = 30002


class UrOptions(DriverOptions, frozen=True, kw_only=True, tag="universal_robots"):
    """A Universal Robots controller, CB3 or e-Series, in remote control.

    Without `tcp` and `payload_com_m` the controller is told the tool centre point of the model and the load that is set
    with `motion.SetLoad`; `payload_kg` is the mass of the tool itself.
    """

    host: Annotated[str, Meta(min_length=1, description="Address of the controller")]
    client: Annotated[
        Literal["ur_rtde", "script"],
        Meta(
            description="`ur_rtde`: the library ur-rtde and its script; needs flexcell[ur]. "
            "`script`: RTDE and the script of this project; on every Python and machine"
        ),
    ] = "ur_rtde"
    ports: Annotated[UrPorts, Meta(description="Other ports than usual, with `client: script` only")] = UrPorts()
    tcp: (
        Annotated[
            tuple[Metres, Metres, Metres, Radians, Radians, Radians],
            Meta(description="Tool centre point at the flange: metres, then a rotation vector"),
        ]
        | None
    ) = None
    payload_kg: Annotated[float, Meta(ge=0.0, le=20.0, description="Mass of the tool")] = 0.0
    payload_com_m: (
        Annotated[tuple[Metres, Metres, Metres], Meta(description="Centre of mass of the tool at the flange")] | None
    ) = None
    lookahead_s: Annotated[float, Meta(ge=0.03, le=0.2, description="Smooths the set points, and delays them")] = 0.05
    gain: Annotated[float, Meta(ge=100.0, le=2000.0, description="Gain with which set points are followed")] = 300.0
    path_tolerance_rad: Annotated[
        float, Meta(gt=0.0, le=1.0, description="How far a joint may be behind its set point; it is by the lookahead")
    ] = 0.3
    start_s: Annotated[
        float,
        Meta(
            ge=1.0,
            le=LONGEST_START_S,
            description="Seconds that the control program may take until it runs and has taken tool and payload",
        ),
    ] = 10.0
    watchdog_hz: Annotated[
        float, Meta(ge=1.0, le=100.0, description="Without a set point for a period of it the controller stops the arm")
    ] = 10.0
    stale_s: Annotated[
        float,
        Meta(ge=0.05, le=5.0, description="Seconds without a new measurement until the arm counts as lost"),
    ] = 0.2
    process_silence_s: Annotated[
        float,
        Meta(
            ge=LONGEST_SILENCE_S,
            le=10.0,
            description="Seconds that its process may be silent until it is ended; a sound one is for 0.6 s at most, "
            "while it ends the program",
        ),
    ] = 1.0

    def __post_init__(self) -> None:
        """Refuse ports that the client would not use."""
        if self.client == "ur_rtde" and self.ports != UrPorts():
            raise ValueError("`ports` needs `client: script`: ur-rtde has its ports built in")
