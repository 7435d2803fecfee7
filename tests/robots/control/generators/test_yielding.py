"""After a failure the set point comes to rest, then moves to where the arm is, within all limits."""

from __future__ import annotations

import numpy as np
import pytest

from robots.control.generators.yielding import YieldGenerator
from robots.port import Array
from tests.robots.control.limit_watch import STEP_S, limits

START, VELOCITY = np.array([0.2, -0.1]), np.array([0.5, -0.3])


def yielding(*, velocity: Array = VELOCITY) -> YieldGenerator:
    return YieldGenerator(limits=limits(), position=START, velocity=velocity, acceleration=np.zeros(2))


def steps_until_complete(generator: YieldGenerator, measured: Array) -> list[Array]:
    """Return the set points, the first one included."""
    positions = [generator.position.copy()]
    while not generator.complete:
        generator.step(STEP_S, measured)
        positions.append(generator.position.copy())
        assert len(positions) < 3000
    return positions


def test_a_moving_set_point_continues_from_its_velocity_and_ends_at_the_measured_joints() -> None:
    positions = np.array(steps_until_complete(yielding(), np.array([0.1, 0.05])))
    velocities = np.diff(positions, axis=0) / STEP_S
    assert velocities[0] == pytest.approx(VELOCITY, abs=0.01)
    assert np.abs(np.diff(velocities, axis=0)).max() / STEP_S < 15.0 * 1.01
    assert positions[-1] == pytest.approx([0.1, 0.05], abs=1e-9)
    assert velocities[-1] == pytest.approx([0.0, 0.0], abs=1e-3)


def brought_to_rest(measured: Array) -> YieldGenerator:
    """Return a generator whose set point has come to rest at this step."""
    generator = yielding()
    while generator.velocity.any() or not generator.position[0] > START[0]:
        generator.step(STEP_S, measured)
    return generator


def test_the_goal_are_the_joints_measured_when_the_set_point_has_come_to_rest() -> None:
    generator = brought_to_rest(np.array([0.3, 0.1]))
    generator.step(STEP_S, np.array([0.3, 0.1]))
    steps_until_complete(generator, np.array([0.9, 0.9]))
    assert generator.position == pytest.approx([0.3, 0.1], abs=1e-9)


@pytest.mark.parametrize("wrong", range(1, 25))
def test_joints_that_are_measured_wrong_for_a_while_are_no_goal(wrong: int) -> None:
    """One wrong measurement at the moment of rest had the arm go there at its full speed."""
    generator = brought_to_rest(np.array([0.3, 0.1]))
    for _ in range(wrong):
        generator.step(STEP_S, np.array([-1.2, 0.1]))
    steps_until_complete(generator, np.array([0.3, 0.1]))
    assert generator.position == pytest.approx([0.3, 0.1], abs=1e-9)


def test_a_set_point_that_stands_does_not_move_before_enough_was_measured() -> None:
    generator = yielding(velocity=np.zeros(2))
    generator.step(STEP_S, np.array([-1.2, 0.1]))
    positions = np.array(steps_until_complete(generator, np.array([0.3, 0.1])))
    assert positions[:, 0].min() >= START[0] - 1e-9
    assert generator.position == pytest.approx([0.3, 0.1], abs=1e-9)


def test_joints_measured_beyond_a_limit_are_not_followed_there() -> None:
    generator = yielding(velocity=np.zeros(2))
    steps_until_complete(generator, np.array([3.0, -3.0]))
    assert generator.position == pytest.approx([2.0, -2.0], abs=1e-9)


def test_once_complete_the_set_point_stands_still() -> None:
    generator = yielding(velocity=np.zeros(2))
    last = steps_until_complete(generator, START + 0.05)[-1]
    generator.step(STEP_S, START - 0.3)
    assert (generator.complete, generator.position.tolist()) == (True, last.tolist())
