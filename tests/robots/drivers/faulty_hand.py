"""The faults that the SoftHand driver is tested with, and its motion in the middle of which they happen."""

from __future__ import annotations

from engine.skills.hand import HandClose, HandOpen
from robots.drivers.softhand.softhand_driver import SOFTHAND
from tests.robots.drivers.emulated_hand import HAND, HAND_CONNECTIONS, driven_hand, emulated_hand
from tests.robots.drivers.fault_cases import FaultCase
from tests.robots.drivers.faulty_motion import FaultySubject

_REST = "stop at the last reference that was sent"
HAND_CASES = (
    FaultCase(
        name="connection cut", do="cut", cause=("no fresh reading", "no valid answer to"), lost=True, meanwhile=_REST
    ),
    FaultCase(name="device does not answer", do="freeze", cause=("no valid answer to",), lost=True, meanwhile=_REST),
    FaultCase(
        name="answers too slow",
        do="slow",
        values={"seconds": 1.0},
        cause=("no valid answer to",),
        lost=True,
        meanwhile=_REST,
    ),
    FaultCase(name="garbage", do="garbage", cause=("but bytes that are no answer",), lost=True, meanwhile=_REST),
    FaultCase(name="wrong checksums", do="checksum", cause=("the checksum of a frame is",), lost=True, meanwhile=_REST),
    FaultCase(
        name="device restarted",
        do="restart",
        # Over TCP it closes the socket as well, which shows first.
        cause=("the hand is not activated", "socket disconnected"),
        lost=False,
        meanwhile="stop where they are",
    ),
    FaultCase(
        name="motor switched off",
        do="inactive",
        cause=("the hand is not activated",),
        lost=False,
        meanwhile="stop where they are",
    ),
    FaultCase(
        name="over-current",
        do="current",
        values={"current_ma": 2000},
        cause=("over-current",),
        lost=False,
        restore=("current", {"current_ma": 0}),
        meanwhile="stop where they are",
    ),
    FaultCase(
        name="second client",
        do="foreign",
        values={"ticks": 18000},
        cause=("another client commands the hand",),
        lost=False,
        meanwhile="go where the other client says",
    ),
)
FAULTY_HAND = FaultySubject(
    driver=SOFTHAND,
    connections=HAND_CONNECTIONS,
    cases=HAND_CASES,
    test="tests/robots/drivers/test_softhand_faults.py",
    device=HAND,
    emulated=emulated_hand,
    driven=lambda emulator: driven_hand(emulator, enable=True),
    prepare=lambda emulator: emulator.do("object", share=None),
    first=HandOpen(),
    moving=HandClose(percent=80.0, time_s=4.0),
    under_way=lambda state: 2000 < state["position_ticks"] < 8000,
    at_rest=lambda state: not state["moving"],
    refused=HandOpen(),
    last=HandClose(percent=60.0, time_s=1.0),
)
