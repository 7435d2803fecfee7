"""A Franka Hand that gripped grips again: its states belong to its requests, and go where these say."""

from __future__ import annotations

import asyncio
import gc
from collections.abc import Callable
from pathlib import Path

import pytest

from engine.errors import FlexcellError
from robots.drivers.franka_hand.franka_hand_reading import CloseFingers, FrankaHandReading
from robots.drivers.franka_hand.franka_hand_transport import FrankaHandTransport
from robots.drivers.franka_hand.hand_protocol import HAND_PORT
from robots.drivers.replay.replay_emulator import ReplayOptions
from robots.drivers.replay.serve_replay import serve_replay
from robots.io.wire.wire_capture import NO_CAPTURE, WireCapture
from tests.robots.drivers.emulated_device import replayed
from tests.robots.drivers.franka_hand.scripted_hand import ScriptedHand

CLOSE = CloseFingers(number=1, speed_m_s=0.1, force_n=30.0)


def gripped(
    host: str, capture: WireCapture = NO_CAPTURE, measure: Callable[[str], None] = lambda _: None
) -> list[FrankaHandReading]:
    """Close, and return the readings before it and once the hand has ended it; `measure` lets the hand say more."""
    transport = FrankaHandTransport(
        host, timeout_s=30.0, command_tap=capture.tap("hand_commands"), state_tap=capture.tap("hand_states")
    )
    transport.open()
    try:
        measure("before")
        readings = [transport.read()]
        transport.write(CLOSE)
        measure("after")
        while (reading := transport.read()).ended != CLOSE.number or not reading.state.is_grasping:
            pass
        return [*readings, reading]
    finally:
        transport.close()


def recorded(folder: Path) -> tuple[list[FrankaHandReading], Path, Path]:
    """Return what was read of a hand, and the captures of it."""
    capture = WireCapture(folder, device="arm/gripper")
    hand = ScriptedHand()

    def measure(when: str) -> None:
        if when == "before":
            hand.measure(is_grasping=False, width_m=0.07)
            return
        hand.end(CLOSE.number)
        hand.measure(is_grasping=True, width_m=0.03)

    readings = gripped(hand.host, capture, measure)
    hand.close()
    capture.close()
    gc.collect()
    (commands,) = folder.glob("*.hand_commands.*")
    (states,) = folder.glob("*.hand_states.*")
    return readings, commands, states


def test_a_hand_that_gripped_grips_again(tmp_path: Path) -> None:
    before, commands, states = recorded(tmp_path)
    assert [each.state.width_m for each in before] == [0.07, 0.03]
    with replayed(commands, states=str(states), port=str(HAND_PORT)) as replay:
        after = gripped(str(replay.place["host"]))
        assert replay.do("state")["mismatch"] == ""
    assert after == before


def test_requests_without_their_states_and_states_without_their_requests_are_refused(tmp_path: Path) -> None:
    _, commands, states = recorded(tmp_path)
    for options in (ReplayOptions(file=str(commands)), ReplayOptions(file=str(states))):
        with pytest.raises(FlexcellError, match="the states of a hand belong to its requests") as refused:
            asyncio.run(serve_replay(options, lambda _: None))
        assert "states=" in (refused.value.hint or "")
