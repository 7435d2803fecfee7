"""The faults that the driver of servo arms is tested with in the middle of a motion."""

from __future__ import annotations

from tests.robots.drivers.fault_cases import FaultCase

WATCHDOG = "holds by the watchdog of its board"
CASES = (
    FaultCase(
        name="line cut",
        do="cut",
        cause=("no valid answer for ", "the serial line failed"),
        lost=True,
        meanwhile=WATCHDOG,
    ),
    FaultCase(
        name="board does not answer", do="freeze", cause=("no valid answer for ",), lost=True, meanwhile=WATCHDOG
    ),
    FaultCase(name="garbage", do="garbage", cause=("but bytes that are no answer: ",), lost=True, meanwhile=WATCHDOG),
    FaultCase(
        name="line refused",
        do="error",
        values={"words": "servo 2"},
        cause=("the board refused a line: servo 2",),
        lost=False,
        restore=("error", {"words": ""}),
        meanwhile="holds at the last set point",
    ),
    FaultCase(
        name="board reset",
        do="reset",
        cause=("the board has restarted", "the board has started and is not enabled"),
        lost=False,
        meanwhile="holds at its home angles",
    ),
    FaultCase(
        name="control process killed", do="kill process", cause=("was ended by SIGKILL",), lost=True, meanwhile=WATCHDOG
    ),
    FaultCase(
        name="control process hangs", do="hold process", cause=("process silent: ",), lost=True, meanwhile=WATCHDOG
    ),
)
