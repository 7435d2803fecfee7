"""The faults that the ABB driver with Externally Guided Motion is tested with in the middle of a motion."""

from __future__ import annotations

from tests.robots.drivers.fault_cases import FaultCase

COMM_TIMEOUT = "rests at the last set point; its program ends guided motion by CommTimeout"
STOPS = "is stopped by the controller"

_GO_ON: tuple[str, dict[str, object]] = ("go_on", {})
CASES = (
    FaultCase(
        name="measurements cut",
        do="egm_fault",
        values={"fault": "cut"},
        cause=("controller silent: ",),
        lost=True,
        meanwhile=COMM_TIMEOUT,
    ),
    FaultCase(
        name="measurements stand still",
        do="egm_fault",
        values={"fault": "freeze"},
        cause=("controller silent: ",),
        lost=True,
        meanwhile=COMM_TIMEOUT,
    ),
    FaultCase(
        name="garbage",
        do="egm_fault",
        values={"fault": "garbage"},
        cause=("garbage: EGM sent ",),
        lost=True,
        meanwhile=COMM_TIMEOUT,
    ),
    FaultCase(
        name="set points get lost",
        do="egm_fault",
        values={"fault": "deaf"},
        cause=("EGM stopped: ", "off the path", "lags"),
        lost=False,
        meanwhile=COMM_TIMEOUT,
    ),
    FaultCase(
        name="emergency stop",
        do="estop",
        values={"on": True},
        cause=("drives off: ",),
        lost=False,
        restore=_GO_ON,
        meanwhile=STOPS,
    ),
    FaultCase(
        name="safeguard open",
        do="guard",
        values={"on": True},
        cause=("drives off: ",),
        lost=False,
        restore=_GO_ON,
        meanwhile=STOPS,
    ),
    FaultCase(
        name="mode selector in manual",
        do="mode",
        values={"mode": "manual"},
        cause=("program stopped: ",),
        lost=False,
        restore=_GO_ON,
        meanwhile=STOPS,
    ),
    FaultCase(
        name="program stopped",
        do="program",
        values={"on": False},
        cause=("program stopped: ",),
        lost=False,
        restore=_GO_ON,
        meanwhile=STOPS,
    ),
    FaultCase(
        name="control process killed",
        do="kill process",
        cause=("was ended by SIGKILL",),
        lost=True,
        meanwhile=COMM_TIMEOUT,
    ),
    FaultCase(
        name="control process hangs", do="hold process", cause=("process silent: ",), lost=True, meanwhile=COMM_TIMEOUT
    ),
)
