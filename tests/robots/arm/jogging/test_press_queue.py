"""Presses one after the other: each for its shortest time, none after its release for long, none of a silent page."""

from __future__ import annotations

import pytest

from engine.skills.jogging import MOST_WAIT_S, JogCommand
from robots.arm.jogging.press_queue import PressQueue

WATCHDOG_S, LEAST_S = 0.12, 0.1
UP, LEFT, STILL = (0.0, 0.0, 0.05), (0.0, 0.05, 0.0), (0.0, 0.0, 0.0)


def press(velocity: tuple[float, ...]) -> JogCommand:
    return JogCommand(velocity=velocity, least_s=LEAST_S)


def at(queue: PressQueue, now_s: float) -> tuple[float, ...] | None:
    current = queue.advance(now_s)
    return current.velocity if current is not None else None


def test_a_press_that_is_released_at_once_is_executed_for_its_shortest_time_from_when_it_moves() -> None:
    queue = PressQueue(WATCHDOG_S)
    queue.take(press(UP), 0.0)
    queue.take(JogCommand(velocity=STILL), 0.01)
    current = queue.advance(0.3)
    assert current is not None
    current.moving_since_s = 0.3
    assert (at(queue, 0.39), at(queue, 0.41)) == (UP, None)


def test_presses_are_executed_in_their_order() -> None:
    queue = PressQueue(WATCHDOG_S)
    queue.take(press(UP), 0.0)
    queue.take(press(LEFT), 0.05)
    queue.take(JogCommand(velocity=STILL), 0.06)
    first = queue.advance(0.07)
    assert first is not None
    assert first.velocity == UP
    first.moving_since_s = 0.07
    assert (at(queue, 0.16), at(queue, 0.18)) == (UP, LEFT)


def test_a_released_press_that_is_blocked_or_not_checked_in_time_is_dropped() -> None:
    queue = PressQueue(WATCHDOG_S)
    queue.take(press(UP), 0.0)
    queue.take(JogCommand(velocity=STILL), 0.01)
    assert at(queue, 0.01 + MOST_WAIT_S - 0.01) == UP
    assert at(queue, 0.01 + MOST_WAIT_S) is None
    assert queue.dropped == 1
    queue.take(press(LEFT), 1.0)
    current = queue.advance(1.0)
    assert current is not None
    current.blocked = True
    assert at(queue, 1.05) == LEFT
    queue.take(JogCommand(velocity=STILL), 1.06)
    # A block is told of otherwise.
    assert (at(queue, 1.06), queue.dropped) == (None, 1)


def test_what_a_command_has_waited_on_its_way_counts() -> None:
    queue = PressQueue(WATCHDOG_S)
    queue.take(press(UP), 1.0)
    queue.take(JogCommand(velocity=STILL, age_s=0.2), 1.0)
    assert (at(queue, 0.8 + MOST_WAIT_S - 0.01), at(queue, 0.8 + MOST_WAIT_S)) == (UP, None)


def test_a_press_that_has_moved_the_arm_is_not_dropped() -> None:
    queue = PressQueue(WATCHDOG_S)
    queue.take(press(UP), 0.0)
    current = queue.advance(0.0)
    assert current is not None
    current.moving_since_s = 0.02
    queue.take(JogCommand(velocity=STILL), 0.03)
    assert (at(queue, 0.5), queue.dropped) == (None, 0)


@pytest.mark.parametrize("least_s", [0.0, LEAST_S])
def test_a_moving_press_without_commands_ends_with_the_watchdog(least_s: float) -> None:
    """Nobody has released it: the page has fallen silent, so its shortest time does not count."""
    queue = PressQueue(WATCHDOG_S)
    queue.take(JogCommand(velocity=UP, least_s=least_s), 0.0)
    current = queue.advance(0.0)
    assert current is not None
    current.moving_since_s = 0.02
    queue.take(JogCommand(velocity=UP), 0.04)
    assert (at(queue, 0.04 + WATCHDOG_S - 0.01), at(queue, 0.04 + WATCHDOG_S)) == (UP, None)
    assert queue.dropped == 0


@pytest.mark.parametrize("later", [JogCommand(velocity=UP), JogCommand(velocity=STILL)], ids=["held", "released"])
def test_a_press_that_has_not_moved_waits_in_silence_and_goes_on_when_it_is_heard(later: JogCommand) -> None:
    queue = PressQueue(WATCHDOG_S)
    queue.take(press(UP), 0.0)
    silent = queue.advance(2 * WATCHDOG_S)
    assert silent is not None
    assert silent.is_silent(2 * WATCHDOG_S, WATCHDOG_S)
    queue.take(later, 2 * WATCHDOG_S)
    assert queue.current is silent
    assert not silent.is_silent(2 * WATCHDOG_S, WATCHDOG_S)
    assert queue.dropped == 0


def test_a_press_of_which_nothing_is_heard_again_is_dropped_and_counted() -> None:
    queue = PressQueue(WATCHDOG_S)
    queue.take(press(UP), 0.0)
    assert at(queue, WATCHDOG_S + MOST_WAIT_S) is None
    assert queue.dropped == 1


def test_a_plain_command_changes_the_held_press_and_ends_it_at_once() -> None:
    """As before there were presses: a velocity without a shortest time is followed as it comes."""
    queue = PressQueue(WATCHDOG_S)
    queue.take(JogCommand(velocity=UP), 0.0)
    queue.take(JogCommand(velocity=LEFT), 0.05)
    assert at(queue, 0.05) == LEFT
    queue.take(JogCommand(velocity=STILL), 0.06)
    assert at(queue, 0.06) is None
