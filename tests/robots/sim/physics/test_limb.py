"""An arm of two bones: its bones keep their lengths, its elbow hangs, and nothing of it jumps."""

from __future__ import annotations

import math

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from robots.port import Array
from robots.scene.sim_scene import PersonBody
from robots.sim.physics.limb import Limb

PERSON = PersonBody(name="anna", shoulder=(0.1, -0.2, 0.3), hand_rests=(0.1, 0.1, 0.2))
SHOULDER = np.array(PERSON.shoulder)
LIMB = Limb(PERSON)
STEP_S = 0.001

_share = st.floats(-1.0, 1.0)
directions = st.tuples(_share, _share, _share).filter(lambda v: math.hypot(*v) > 0.1)
distances = st.floats(0.0, 1.5)


def _hand(direction: tuple[float, float, float], distance_m: float) -> Array:
    return SHOULDER + np.array(direction) / math.hypot(*direction) * distance_m


@settings(deadline=None)
@given(directions, distances)
def test_bones_keep_their_lengths_and_meet_at_the_elbow(
    direction: tuple[float, float, float], distance_m: float
) -> None:
    hand = _hand(direction, distance_m)
    pose = LIMB.pose(hand, LIMB.hanging(hand))
    upper, fore = Rotation.from_quat(np.roll(pose.wxyz[:2], -1, axis=1)).as_matrix()[:, :, 2]
    elbow = SHOULDER + upper * PERSON.upper_arm_m
    assert np.allclose(pose.xyz[0], SHOULDER + upper * PERSON.upper_arm_m / 2.0, atol=1e-9)
    assert np.allclose(pose.xyz[1], elbow + fore * PERSON.forearm_m / 2.0, atol=1e-9)
    assert np.allclose(pose.xyz[2], elbow + fore * PERSON.forearm_m, atol=1e-9)


@settings(deadline=None)
@given(directions, distances)
def test_a_hand_is_where_it_is_wished_if_the_arm_is_long_enough_and_else_in_that_direction(
    direction: tuple[float, float, float], distance_m: float
) -> None:
    hand = _hand(direction, distance_m)
    least_m, greatest_m = PERSON.reach_m
    reached = LIMB.pose(hand, LIMB.hanging(hand)).xyz[2]
    assert abs(math.dist(reached, SHOULDER) - min(max(LIMB.away_m(hand), least_m), greatest_m)) < 1e-9
    if least_m <= LIMB.away_m(hand) <= greatest_m:
        assert np.allclose(reached, hand, atol=1e-9)


@settings(deadline=None)
@given(directions, st.floats(0.1, 0.6))
def test_the_elbow_hangs_as_low_as_it_can(direction: tuple[float, float, float], distance_m: float) -> None:
    hand = _hand(direction, distance_m)
    axis = (hand - SHOULDER) / distance_m
    hanging = LIMB.hanging(hand)
    turned = Rotation.from_rotvec(axis * 0.3)
    for other in (turned.apply(hanging), turned.inv().apply(hanging)):
        # Within a millionth of the vertical no side counts as lower.
        assert hanging[2] <= other[2] + 1e-6


def test_an_elbow_held_up_sinks_to_where_it_hangs_no_faster_than_it_may() -> None:
    hand = _hand((0.0, 1.0, 0.0), 0.4)
    side = Rotation.from_rotvec([0.0, 3.0, 0.0]).apply(LIMB.hanging(hand))
    turns: list[float] = []
    for _ in range(4000):
        after = LIMB.carried_on(side, hand, step_s=STEP_S)
        turns.append(math.acos(min(1.0, float(side @ after))))
        side = after
    assert max(turns) / STEP_S < 3.01
    assert np.allclose(side, LIMB.hanging(hand))


def test_nothing_jumps_where_the_hand_passes_right_over_the_shoulder() -> None:
    """There the lower side of the arm is the other one from one instant to the next."""
    places = [SHOULDER + np.array([0.0, y, 0.45]) for y in np.arange(-0.3, 0.3, 0.001)]
    side = LIMB.hanging(places[0])
    poses = [LIMB.pose(places[0], side)]
    for place in places[1:]:
        side = LIMB.carried_on(side, place, step_s=STEP_S)
        poses.append(LIMB.pose(place, side))
    ways = np.linalg.norm(np.diff([pose.xyz for pose in poses], axis=0), axis=2)
    assert ways.max() / STEP_S < 2.5
