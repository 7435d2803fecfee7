"""The faults that the driver of the FR3 is tested with."""

from __future__ import annotations

from tests.robots.drivers.fault_cases import FaultCase

_ROBOT = "is stopped by the robot"
_MISSES = "is stopped by the robot, which misses its set points"
# libfranka listens to states, and notices their end after a second, or that of the connection before.
_GONE = ("controller silent", "link cut")
# The emulator forgets it when a person enables the arm, as a robot does.
_RECOVERED = ("state", dict[str, object]())


def _released(name: str) -> tuple[str, dict[str, object]]:
    return (name, {"on": False})


CASES = (
    FaultCase(name="connection cut", do="cut", cause=_GONE, lost=True, meanwhile=_MISSES),
    FaultCase(
        name="controller does not answer", do="freeze", cause=("controller silent",), lost=True, meanwhile=_MISSES
    ),
    FaultCase(name="controller restarted", do="restart", cause=_GONE, lost=True, meanwhile=_ROBOT),
    FaultCase(
        name="control process killed", do="kill process", cause=("was ended by SIGKILL",), lost=True, meanwhile=_MISSES
    ),
    FaultCase(
        name="collision",
        do="reflex",
        cause=("reflex: joint_reflex",),
        lost=False,
        restore=_RECOVERED,
        meanwhile=_ROBOT,
        at_device="free it",
    ),
    FaultCase(
        name="set points beyond what it permits",
        do="reflex",
        values={"errors": ["joint_motion_generator_velocity_discontinuity"]},
        cause=("motion limits: joint_motion_generator_velocity_discontinuity",),
        lost=False,
        restore=_RECOVERED,
        meanwhile=_ROBOT,
    ),
    FaultCase(
        name="user stop",
        do="user_stop",
        cause=("user stop",),
        lost=False,
        restore=_released("user_stop"),
        meanwhile=_ROBOT,
        at_device="release it",
    ),
    FaultCase(
        name="buttons of the pilot",
        do="guiding",
        cause=("guiding",),
        lost=False,
        restore=_released("guiding"),
        meanwhile=_ROBOT,
        at_device="release them",
    ),
    FaultCase(
        name="joints locked",
        do="lock",
        cause=("not ready",),
        lost=False,
        restore=_released("lock"),
        meanwhile=_ROBOT,
        at_device="unlock them",
    ),
)
