"""Moves until contact: what counts, what does not, and how soon they stop."""

from __future__ import annotations

import numpy as np
import pytest

from robots.control.generators.guarded_motion import GUARDED_STOP_S, GuardedMotion, decode_peak_n
from robots.control.generators.trajectory_playback import TrajectoryPlayback
from robots.port import Array, ContactCondition, JointTrajectory
from tests.robots.control.limit_watch import STEP_S
from tests.robots.control.plane_arm import plane_state
from tests.robots.control.spring_wall import Wall, WallRig

START, END = np.array([0.2, 0.9]), np.array([0.5, 1.1])


def trajectory(duration_s: float = 1.0) -> JointTrajectory:
    """Return a minimum-jerk motion that moves the tool along +y, mostly."""
    u = np.linspace(0.0, 1.0, 501)[:, None]
    return JointTrajectory(
        dt_s=duration_s / 500,
        position_rad=START + (END - START) * (10 * u**3 - 15 * u**4 + 6 * u**5),
        velocity_rad_s=(END - START) * (30 * u**2 - 60 * u**3 + 30 * u**4) / duration_s,
    )


def new_guarded(contact: ContactCondition, *, duration_s: float = 1.0) -> GuardedMotion:
    playback = TrajectoryPlayback(
        trajectory(duration_s),
        acceleration_rad_s2=np.full(2, 15.0),
        jerk_rad_s3=np.full(2, 7500.0),
        shortest_stop_s=GUARDED_STOP_S,
    )
    return GuardedMotion(playback, contact)


def pushed(guarded: GuardedMotion, force: tuple[float, float, float], periods: int, *, pace: float = 1.0) -> None:
    """Let periods pass with this force at the tool."""
    state = plane_state()
    state.wrench[:3] = force
    for _ in range(periods):
        guarded.step(STEP_S, target_pace=pace, state=state)


@pytest.mark.parametrize("direction", [(0.0, 0.0, 0.0), (0.0, -1.0, 0.0)])
def test_at_a_wall_it_stops_within_a_third_of_the_force_beyond_the_threshold(
    direction: tuple[float, float, float],
) -> None:
    guarded = new_guarded(ContactCondition(force_n=10.0, direction=direction), duration_s=10.0)
    bench = WallRig(guarded, Wall(5000.0, lambda x: 0.65))
    bench.run()
    assert guarded.contact
    assert guarded.goal is None
    assert 0.1 < guarded.progress < 0.9
    assert 10.0 <= -bench.forces[-1] < 13.0
    assert guarded.velocity.tolist() == [0.0, 0.0]


def test_without_a_wall_it_ends_at_its_goal_without_contact() -> None:
    guarded = new_guarded(ContactCondition(force_n=10.0))
    pushed(guarded, (0.0, 0.0, 0.0), 1001)
    assert (guarded.complete, guarded.contact, guarded.progress) == (True, False, 1.0)
    assert np.allclose(np.array(guarded.goal), END)


def test_a_force_across_the_direction_does_not_count() -> None:
    guarded = new_guarded(ContactCondition(force_n=10.0, direction=(0.0, -1.0, 0.0)))
    pushed(guarded, (0.0, 0.0, 0.0), 50)
    pushed(guarded, (40.0, 40.0, 0.0), 100)
    assert not guarded.contact


def test_what_already_presses_at_the_start_does_not_count() -> None:
    guarded = new_guarded(ContactCondition(force_n=10.0))
    pushed(guarded, (0.0, -30.0, 0.0), 300)
    assert not guarded.contact
    pushed(guarded, (0.0, -41.0, 0.0), 20)
    assert guarded.contact


def test_a_spike_of_two_periods_does_not_count() -> None:
    guarded = new_guarded(ContactCondition(force_n=10.0))
    pushed(guarded, (0.0, 0.0, 0.0), 50)
    pushed(guarded, (0.0, -50.0, 0.0), 2)
    pushed(guarded, (0.0, 0.0, 0.0), 20)
    assert not guarded.contact


def test_a_push_while_it_is_held_does_not_count_but_one_after_that_does() -> None:
    guarded = new_guarded(ContactCondition(force_n=10.0))
    pushed(guarded, (0.0, 0.0, 0.0), 300)
    pushed(guarded, (0.0, -50.0, 0.0), 300, pace=0.0)
    assert guarded.stopped
    assert not guarded.contact
    pushed(guarded, (0.0, 0.0, 0.0), 50)
    assert guarded.moving
    pushed(guarded, (0.0, -50.0, 0.0), 50)
    assert guarded.complete


def test_a_contact_that_shows_only_while_the_arm_settles_counts_too() -> None:
    guarded = new_guarded(ContactCondition(force_n=10.0))
    pushed(guarded, (0.0, 0.0, 0.0), 1001)
    assert not guarded.contact
    pushed(guarded, (0.0, -12.0, 0.0), 5)
    assert (guarded.contact, guarded.complete, guarded.goal) == (True, True, None)


def test_it_stops_on_its_path_within_the_acceleration() -> None:
    guarded = new_guarded(ContactCondition(force_n=10.0), duration_s=0.4)
    velocities: list[Array] = [guarded.velocity.copy()]
    state = plane_state()
    for step in range(260):
        state.wrench[1] = -50.0 if step > 150 else 0.0
        guarded.step(STEP_S, target_pace=1.0, state=state)
        velocities.append(guarded.velocity.copy())
        along = (guarded.position - START) / (END - START)
        assert abs(along[0] - along[1]) < 1e-12
    assert guarded.complete
    assert np.abs(np.diff(np.array(velocities), axis=0)).max() / STEP_S < 15.0


def test_the_greatest_force_beyond_the_tare_is_recorded_also_while_it_stops_and_is_held() -> None:
    guarded = new_guarded(ContactCondition(force_n=10.0, direction=(0.0, -1.0, 0.0)))
    pushed(guarded, (0.0, -3.0, 0.0), 300)
    assert decode_peak_n(guarded.data()) == pytest.approx(0.0, abs=1e-12)
    pushed(guarded, (0.0, -11.0, 0.0), 2)
    assert decode_peak_n(guarded.data()) == pytest.approx(8.0)
    pushed(guarded, (0.0, -30.0, 0.0), 300, pace=0.0)
    pushed(guarded, (0.0, 40.0, 0.0), 5)
    assert decode_peak_n(guarded.data()) == pytest.approx(27.0)


def test_the_tare_is_the_mean_of_a_force_that_changes() -> None:
    """Between 10 N and 30 N, so 20 N."""
    guarded = new_guarded(ContactCondition(force_n=10.0, direction=(0.0, -1.0, 0.0)))
    for step in range(10):
        pushed(guarded, (0.0, -10.0 if step % 2 else -30.0, 0.0), 1)
    pushed(guarded, (0.0, -29.0, 0.0), 50)
    assert not guarded.contact
    assert decode_peak_n(guarded.data()) == pytest.approx(9.0, abs=0.5)
    pushed(guarded, (0.0, -31.0, 0.0), 5)
    assert guarded.contact
