"""The faults that the ABB driver is tested with in the middle of a motion, and what is expected of each."""

from __future__ import annotations

from tests.robots.drivers.fault_cases import FaultCase

COMPLETES = "ends the path that the controller has, then rests"
STOPPED = "is stopped by the request of the driver"
STOPS = "is stopped by the controller; the driver withdraws the path"
LOSES_PATH = "is stopped by the controller, which forgets the path"

_GO_ON: tuple[str, dict[str, object]] = ("go_on", {})
CASES = (
    FaultCase(name="connection cut", do="cut", cause=("link cut: ",), lost=True, meanwhile=COMPLETES),
    FaultCase(
        name="state port closed",
        do="close_port",
        values={"port": "state"},
        cause=("link cut: ",),
        lost=True,
        meanwhile=STOPPED,
    ),
    FaultCase(
        name="motion port closed",
        do="close_port",
        values={"port": "motion"},
        cause=("link cut: the controller closed the motion connection",),
        lost=False,
        meanwhile=COMPLETES,
    ),
    FaultCase(
        name="controller does not answer", do="freeze", cause=("controller silent: ",), lost=True, meanwhile=COMPLETES
    ),
    FaultCase(
        name="state messages too slow",
        do="slow",
        values={"seconds": 2.5},
        cause=("controller silent: ",),
        lost=True,
        meanwhile=STOPPED,
    ),
    FaultCase(name="garbage", do="garbage", cause=("garbage: ",), lost=True, meanwhile=STOPPED),
    FaultCase(
        name="requests refused, at a hold",
        do="refuse",
        cause=("refused: the controller replied with failure",),
        lost=False,
        meanwhile=COMPLETES,
    ),
    FaultCase(
        name="emergency stop",
        do="estop",
        values={"on": True},
        cause=("emergency stop: ",),
        lost=False,
        restore=_GO_ON,
        meanwhile=STOPS,
    ),
    FaultCase(
        name="motors off",
        do="drives",
        values={"on": False},
        cause=("drives off: ",),
        lost=False,
        restore=_GO_ON,
        meanwhile=STOPS,
    ),
    FaultCase(
        name="mode selector in manual",
        do="mode",
        values={"mode": "manual"},
        cause=("manual mode: ",),
        lost=False,
        restore=_GO_ON,
        meanwhile=STOPS,
    ),
    FaultCase(
        name="program stopped",
        do="program",
        values={"on": False},
        cause=("motion not possible: ",),
        lost=False,
        restore=_GO_ON,
        meanwhile=STOPS,
    ),
    FaultCase(
        name="error of the controller",
        do="error",
        values={"code": 50027},
        cause=("controller error: error code 50027",),
        lost=False,
        restore=_GO_ON,
        meanwhile=STOPS,
    ),
    FaultCase(
        name="signals not configured",
        do="unknown",
        cause=("unknown status: ",),
        lost=False,
        restore=_GO_ON,
        meanwhile=STOPPED,
    ),
    FaultCase(
        name="controller restarted",
        do="restart",
        # Each of its ports says so; either may be the first.
        cause=("drives off: ", "link cut: the controller closed the motion connection"),
        lost=False,
        restore=_GO_ON,
        meanwhile=LOSES_PATH,
    ),
    FaultCase(
        name="another program moves the arm",
        do="foreign",
        values={"joints_rad": [0.25, 1.0, 0.0, 0.0, 0.5, 0.0], "seconds": 3.0},
        cause=("off the path: ",),
        lost=False,
        meanwhile=STOPPED,
    ),
)
