"""A stop of a Franka Hand reaches fingers that move, and leaves a grip as it is."""

from __future__ import annotations

import select
from collections.abc import Generator

import pytest

from robots.drivers.franka_hand.franka_hand_reading import CloseFingers, HomeFingers, MoveFingers, StopFingers
from robots.drivers.franka_hand.franka_hand_transport import FrankaHandTransport
from robots.drivers.franka_hand.hand_protocol import HandRequest
from tests.robots.drivers.franka_hand.scripted_hand import ScriptedHand

LIMIT_S = 60.0
CLOSE = CloseFingers(number=7, speed_m_s=0.1, force_n=30.0)


@pytest.fixture
def hand() -> Generator[ScriptedHand]:
    """A hand that is connected."""
    made = ScriptedHand()
    yield made
    made.close()


@pytest.fixture
def transport(hand: ScriptedHand) -> Generator[FrankaHandTransport]:
    """The transport on it."""
    opened = FrankaHandTransport(hand.host, timeout_s=LIMIT_S)
    opened.open()
    yield opened
    opened.close()


def arrived(transport: FrankaHandTransport) -> None:
    """Wait until the hand's message is there, unread."""
    commands = transport._commands  # pyright: ignore[reportPrivateUsage]
    assert commands is not None
    select.select([commands], [], [], LIMIT_S)


def test_a_stop_that_comes_when_the_grip_holds_already_is_not_sent(
    hand: ScriptedHand, transport: FrankaHandTransport
) -> None:
    """The reply is there, and nobody has read it yet."""
    transport.write(CLOSE)
    hand.end(CLOSE.number)
    arrived(transport)
    transport.write(StopFingers())
    hand.measure(is_grasping=True)
    assert transport.read().ended == CLOSE.number
    transport.close()
    hand.close()
    assert HandRequest.STOP not in hand.requests


def test_a_stop_of_fingers_that_grip_before_the_hand_has_said_so_is_not_sent(
    hand: ScriptedHand, transport: FrankaHandTransport
) -> None:
    transport.write(CLOSE)
    hand.measure(is_grasping=True)
    transport.read()
    transport.write(StopFingers())
    transport.close()
    hand.close()
    assert HandRequest.STOP not in hand.requests


@pytest.mark.parametrize("was_grasping", [False, True])
@pytest.mark.parametrize(
    "command", [CLOSE, MoveFingers(number=8, width_m=0.08, speed_m_s=0.1), HomeFingers(number=9), None], ids=repr
)
def test_fingers_that_move_or_may_move_are_stopped(
    hand: ScriptedHand,
    transport: FrankaHandTransport,
    command: CloseFingers | MoveFingers | HomeFingers | None,
    *,
    was_grasping: bool,
) -> None:
    """Also where they held something before, and after a connection of which nobody knows what the hand executes."""
    hand.measure(is_grasping=was_grasping)
    transport.read()
    if command is not None:
        transport.write(command)
    transport.write(StopFingers())
    assert hand.requests[-1] is HandRequest.STOP
