"""The faults that the driver of Universal Robots is tested with in the middle of a motion, over both its clients."""

from __future__ import annotations

from tests.robots.drivers.fault_cases import FaultCase

WATCHDOG = "is stopped by its watchdog, or by the dashboard"
CONTROLLER = "is stopped by the controller"
CASES = (
    FaultCase(name="connection dropped", do="drop", cause=("link cut: ",), lost=True, meanwhile=WATCHDOG),
    FaultCase(name="connection cut", do="cut", cause=("link cut: ",), lost=True, meanwhile=WATCHDOG),
    FaultCase(
        name="controller does not answer", do="freeze", cause=("controller silent: ",), lost=True, meanwhile=WATCHDOG
    ),
    FaultCase(
        name="answers too slow",
        do="slow",
        values={"value": 3.0},
        cause=("controller silent: ", "link slow: "),
        lost=True,
        meanwhile=WATCHDOG,
    ),
    FaultCase(
        name="garbage",
        do="garbage",
        # The library does not say what it cannot read.
        cause=("link cut: ", "controller silent: ", "was ended by"),
        lost=True,
        meanwhile=WATCHDOG,
    ),
    FaultCase(
        name="control process killed",
        do="kill process",
        cause=("was ended by SIGKILL",),
        lost=True,
        meanwhile=WATCHDOG,
    ),
    FaultCase(
        name="control process hangs", do="hold process", cause=("process silent: ",), lost=True, meanwhile=WATCHDOG
    ),
    FaultCase(
        name="protective stop",
        do="protective_stop",
        cause=("protective stop: ",),
        lost=False,
        meanwhile=CONTROLLER,
        at_device="look at its cause, unlock it after 5 s",
    ),
    FaultCase(
        name="emergency stop",
        do="emergency_stop",
        cause=("emergency stop: ",),
        lost=False,
        meanwhile=CONTROLLER,
        at_device="release the button, power, brakes",
    ),
    FaultCase(
        name="power off",
        do="press",
        values={"command": "power off"},
        cause=("power off: ",),
        lost=False,
        meanwhile=CONTROLLER,
        at_device="power, brakes",
    ),
    FaultCase(
        name="program stopped",
        do="press",
        values={"command": "stop"},
        cause=("program ended: ",),
        lost=False,
        meanwhile=CONTROLLER,
    ),
    FaultCase(
        name="program paused",
        do="press",
        values={"command": "pause"},
        cause=("program paused: ",),
        lost=False,
        meanwhile=CONTROLLER,
        at_device="stop the program",
    ),
)
