"""The faults that the driver of the Franka Hand is tested with, and its motion in the middle of which they happen."""

from __future__ import annotations

from engine.skills.gripper import GripperMove, GripperOpen
from robots.drivers.franka_hand.franka_hand_driver import FRANKA_HAND
from tests.robots.drivers.emulated_gripper import HAND
from tests.robots.drivers.fault_cases import FaultCase
from tests.robots.drivers.faulty_motion import FaultySubject
from tests.robots.drivers.franka_hand.emulated_franka_hand import (
    FRANKA_HAND_CONNECTIONS,
    driven_franka_hand,
    emulated_franka_hand,
)

_GO_ON = "end the motion that the hand has received, then rest"
FRANKA_HAND_CASES = (
    FaultCase(name="connection cut", do="cut", cause=("no fresh reading",), lost=True, meanwhile=_GO_ON),
    FaultCase(
        name="device does not answer",
        do="freeze",
        # The first cause, or that of connecting again.
        cause=("no state within", "no reply within", "the hand closed the connection"),
        lost=True,
        meanwhile=_GO_ON,
    ),
    FaultCase(
        name="hand not homed, as after it was switched on",
        do="homed",
        values={"on": False},
        cause=("the hand is not homed",),
        lost=False,
        meanwhile=_GO_ON,
    ),
)
FAULTY_FRANKA_HAND = FaultySubject(
    driver=FRANKA_HAND,
    connections=FRANKA_HAND_CONNECTIONS,
    cases=FRANKA_HAND_CASES,
    test="tests/robots/drivers/franka_hand/test_franka_hand_faults.py",
    device=HAND,
    emulated=emulated_franka_hand,
    driven=lambda emulator: driven_franka_hand(emulator, enable=True),
    prepare=lambda emulator: emulator.do("object", width_m=None),
    first=GripperOpen(speed_m_s=0.15),
    moving=GripperMove(width_m=0.01, speed_m_s=0.01),
    under_way=lambda state: 0.02 < state["width_m"] < 0.07,
    at_rest=lambda state: state["speed_m_s"] < 0.001,
    refused=GripperOpen(),
    last=GripperMove(width_m=0.06, speed_m_s=0.15),
)
