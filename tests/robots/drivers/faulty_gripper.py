"""The faults that the Robotiq driver is tested with, and its motion in the middle of which they happen."""

from __future__ import annotations

from engine.skills.gripper import GripperMove, GripperOpen
from robots.drivers.robotiq.robotiq_driver import ROBOTIQ
from tests.robots.drivers.emulated_gripper import CONNECTIONS, HAND, driven, emulated
from tests.robots.drivers.fault_cases import FaultCase
from tests.robots.drivers.faulty_motion import FaultySubject

_GO_ON = "end the motion that the gripper has received, then rest"
CASES = (
    FaultCase(name="connection cut", do="cut", cause=("no fresh reading",), lost=True, meanwhile=_GO_ON),
    FaultCase(
        name="device does not answer", do="freeze", cause=("no valid answer within",), lost=True, meanwhile=_GO_ON
    ),
    FaultCase(
        name="answers too slow",
        do="slow",
        values={"seconds": 1.0},
        cause=("no valid answer within",),
        lost=True,
        meanwhile=_GO_ON,
    ),
    FaultCase(
        name="garbage",
        do="garbage",
        cause=("but bytes that are no answer", "was answered with", "is not that of a 2F gripper", "has no end"),
        lost=True,
        meanwhile=_GO_ON,
    ),
    FaultCase(
        name="requests refused",
        do="refuse",
        cause=("Modbus exception 4", "was answered with b'?'"),
        lost=True,
        meanwhile=_GO_ON,
    ),
    FaultCase(
        name="device restarted",
        do="restart",
        cause=("the gripper is not activated",),
        lost=False,
        meanwhile="stop where they are",
    ),
    FaultCase(
        name="over-temperature",
        do="fault",
        values={"code": 8},
        cause=("over-temperature",),
        lost=False,
        restore=("fault", {"code": 0}),
        meanwhile="stop where they are",
    ),
    FaultCase(
        name="over-current (needs a reset)",
        do="fault",
        values={"code": 14},
        cause=("over-current",),
        lost=False,
        meanwhile="stop where they are",
    ),
    FaultCase(
        name="second client",
        do="foreign",
        values={"position": 90},
        cause=("another client commands the gripper",),
        lost=False,
        meanwhile="go where the other client says",
    ),
)
FAULTY_GRIPPER = FaultySubject(
    driver=ROBOTIQ,
    connections=CONNECTIONS,
    cases=CASES,
    test="tests/robots/drivers/test_robotiq_faults.py",
    device=HAND,
    emulated=emulated,
    driven=lambda emulator: driven(emulator, enable=True),
    prepare=lambda emulator: emulator.do("object", width_m=None),
    first=GripperOpen(speed_m_s=0.15),
    moving=GripperMove(width_m=0.01, speed_m_s=0.05),
    under_way=lambda state: 40 < state["position"] < 100,
    at_rest=lambda state: state["contact"] != "MOVING" or bool(state["fault"]),
    refused=GripperOpen(),
    last=GripperMove(width_m=0.06, speed_m_s=0.15),
)
