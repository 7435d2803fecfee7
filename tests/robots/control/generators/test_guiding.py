"""An arm led by hand: the set point follows it, stays inside, and holds it where it was left."""

from __future__ import annotations

import numpy as np

from robots.control.generators.guiding import GuidingGenerator
from robots.control.generators.motion_generator import StreamGenerator
from tests.robots.control.limit_watch import STEP_S, limits
from tests.robots.control.plane_arm import plane_state


def lead(
    guiding: GuidingGenerator, position: tuple[float, float], velocity: tuple[float, float], *, pace: float = 1.0
) -> None:
    """Let one period pass with the arm measured there."""
    guiding.step(STEP_S, target_pace=pace, state=plane_state(np.array(position), np.array(velocity)))


def test_it_is_a_stream_generator() -> None:
    assert isinstance(GuidingGenerator(limits=limits(), start=np.zeros(2), measured=np.zeros(2)), StreamGenerator)


def test_the_set_point_is_the_measured_arm_and_does_not_lead() -> None:
    guiding = GuidingGenerator(limits=limits(), start=np.zeros(2), measured=np.zeros(2))
    lead(guiding, (0.4, -0.3), (0.2, 0.1))
    assert guiding.position.tolist() == [0.4, -0.3]
    assert guiding.velocity.tolist() == [0.2, 0.1]
    assert (guiding.leads, guiding.stopped, guiding.moving, guiding.complete) == (False, False, True, False)


def test_near_a_limit_the_set_point_stays_behind() -> None:
    guiding = GuidingGenerator(limits=limits(), start=np.zeros(2), measured=np.zeros(2), margin_rad=0.03)
    lead(guiding, (1.99, -2.2), (0.2, -0.1))
    assert guiding.position.tolist() == [1.97, -1.97]
    assert guiding.velocity.tolist() == [0.0, 0.0]


def test_held_it_leads_and_brakes_from_how_fast_the_arm_was_led() -> None:
    guiding = GuidingGenerator(limits=limits(), start=np.zeros(2), measured=np.zeros(2))
    lead(guiding, (0.4, 0.0), (0.5, 0.0))
    velocities = [0.5]
    while not guiding.stopped:
        lead(guiding, (0.4, 0.0), (0.5, 0.0), pace=0.0)
        assert guiding.leads
        assert abs(guiding.velocity[0] - velocities[-1]) <= 15.0 * STEP_S + 1e-12
        velocities.append(float(guiding.velocity[0]))
    assert 0.405 < guiding.position[0] < 0.42
    assert not guiding.complete
    lead(guiding, (0.41, 0.0), (0.0, 0.0), pace=1.0)
    assert not guiding.leads


def test_finished_it_holds_the_arm_where_it_is_and_is_complete() -> None:
    guiding = GuidingGenerator(limits=limits(), start=np.zeros(2), measured=np.zeros(2))
    lead(guiding, (0.4, 0.1), (0.0, 0.0))
    guiding.finish()
    for _ in range(3):
        lead(guiding, (0.4, 0.1), (0.0, 0.0))
    assert guiding.complete
    assert guiding.position.tolist() == [0.4, 0.1]


def test_an_arm_led_into_a_limit_is_held_inside() -> None:
    guiding = GuidingGenerator(limits=limits(), start=np.zeros(2), measured=np.zeros(2))
    lead(guiding, (1.969, 0.0), (2.0, 0.0))
    for _ in range(400):
        lead(guiding, (1.99, 0.0), (0.0, 0.0), pace=0.0)
    assert guiding.stopped
    assert guiding.position[0] <= 2.0
