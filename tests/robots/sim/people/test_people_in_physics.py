"""A person's arm in the physics: it goes where it was sent, robots and parts feel it, and contacts are counted."""

from __future__ import annotations

import math

import msgspec
import numpy as np
import pytest

from engine.skills.simulated_world import PushBody
from robots.control.commanding.arm_commands import FollowTrajectory
from robots.port import Array, JointTrajectory, Tolerance
from robots.scene.sim_scene import PersonBody
from robots.sim.commands.world_commands import PushSimBody, RestoreWorld
from robots.sim.people.limb_yielding import GREATEST_PUSH_N
from robots.sim.physics.cell_model import CellModel, build_cell
from tests.robots.sim.people.person import ANNA, AT_LEFT_HAND, OVER_TABLE, REST, SteppedPerson, with_anna
from tests.robots.sim.sim_cell import box, one_arm

IN_TABLE = (0.0, -0.4, -0.02)
PART = (0.0, -0.25, 0.02)


@pytest.fixture(scope="module", name="cell")
def _cell() -> CellModel:
    return build_cell(with_anna(one_arm(box("part", PART))))


@pytest.fixture(name="person")
def _person(cell: CellModel) -> SteppedPerson:
    return SteppedPerson(cell)


def test_the_bodies_are_where_geometry_says_and_the_hand_arrives_when_it_was_said(person: SteppedPerson) -> None:
    person.reach(OVER_TABLE, speed_m_s=1.0)
    due_s = 1.875 * math.dist(ANNA.hand_rests, OVER_TABLE)
    assert person.sample.arrives_in_s == pytest.approx(due_s)
    places = person.places(due_s + 0.002)
    assert places[0][2] == pytest.approx(REST, abs=1e-9)
    assert places[-1][2] == pytest.approx(OVER_TABLE, abs=1e-9)
    assert person.sample.arrives_in_s == 0.0
    speeds = np.linalg.norm(np.diff(places[:, 2], axis=0), axis=1) / person.simulation.step_s
    assert speeds.max() == pytest.approx(1.0, abs=0.01)
    # The elbow does not lie on the way of the hand, yet it keeps its distance from it.
    assert np.ptp(np.linalg.norm(places[:, 2] - places[:, 1], axis=1)) < 1e-9


def test_a_hand_sent_elsewhere_in_mid_motion_jumps_neither_in_place_nor_in_speed(person: SteppedPerson) -> None:
    person.reach(OVER_TABLE, speed_m_s=1.0)
    first = person.places(0.25)
    person.reach((0.25, -0.45, 0.4), speed_m_s=0.6)
    second = person.places(1.5)
    velocities = np.diff(np.concatenate((first, second)), axis=0) / person.simulation.step_s
    steps = np.linalg.norm(np.diff(velocities, axis=0), axis=2)
    assert np.linalg.norm(velocities[len(first) - 1, 2]) > 0.5
    assert steps[:, 2].max() < 0.025
    assert second[-1, 2] == pytest.approx((0.25, -0.45, 0.4), abs=1e-9)


def test_a_hand_that_stays_for_a_while_goes_back_to_where_it_rests(person: SteppedPerson) -> None:
    person.reach(OVER_TABLE, speed_m_s=2.0, stay_s=0.3)
    there_s = person.sample.arrives_in_s
    person.run(there_s + 0.29)
    assert person.sample.hand.xyz == pytest.approx(OVER_TABLE, abs=1e-9)
    person.run(0.02 + there_s)
    assert person.sample.hand.xyz == pytest.approx(REST, abs=1e-9)


def test_a_hand_sent_into_a_fixture_stops_at_it_and_that_is_no_contact(person: SteppedPerson) -> None:
    """The surface of the table is at 0, the ball of the hand has a radius of 5 cm."""
    person.reach(IN_TABLE)
    row = person.simulation.summary.frames.index("anna/hand")
    heights: list[float] = []
    for _ in range(1500):
        person.run(0.001)
        heights.append(float(person.snapshot().frames()[0][row][2]))
    assert min(heights) > ANNA.radius_m - 0.008
    assert heights[-1] == pytest.approx(ANNA.radius_m, abs=0.004)
    assert person.sample.hand.xyz[2] == pytest.approx(ANNA.radius_m, abs=0.004)
    assert person.sample.count.contacts == 0


def test_after_a_fixture_the_hand_is_on_its_motion_again(person: SteppedPerson) -> None:
    person.reach(IN_TABLE)
    person.run(1.0)
    person.reach(OVER_TABLE)
    person.run(3.0)
    assert (person.sample.hand.xyz == np.array(OVER_TABLE)).all()


def test_an_arm_that_moves_into_a_person_pushes_her_away_with_a_bounded_force(cell: CellModel) -> None:
    """The arm turns its first joint by 0.8 rad through the place of her hand, at up to 0.7 m/s."""
    person = SteppedPerson(cell)
    simulation = person.simulation
    beside = np.array((-0.24, -0.2, 0.6))
    person.reach((-0.24, -0.2, 0.6))
    person.run(1.5)
    assert person.sample.count.contacts == 0
    start = person.snapshot().arm("left").desired_rad
    goal = start.copy()
    goal[0] -= 0.8
    simulation.apply(FollowTrajectory(arm="left", motion=1, trajectory=_straight(start, goal), tolerance=Tolerance()))
    displaced_m: list[float] = []
    for _ in range(300):
        person.run(0.01)
        displaced_m.append(float(np.linalg.norm(person.sample.hand.xyz - beside)))
    assert max(displaced_m) > 0.07
    assert 20.0 < person.sample.count.greatest_force_n < 2.0 * GREATEST_PUSH_N
    assert np.abs(person.snapshot().arm("left").position_rad - goal).max() < 0.05


def test_a_push_displaces_a_person_whom_nothing_touches_and_she_comes_back(cell: CellModel) -> None:
    person = SteppedPerson(cell)
    person.reach(OVER_TABLE)
    person.run(1.5)
    push = PushBody(body="anna/hand", force_n=(0.0, 0.0, 60.0), duration_s=0.1)
    person.simulation.apply(PushSimBody(push=push))
    person.run(0.1)
    assert person.sample.hand.xyz[2] - OVER_TABLE[2] > 0.01
    person.run(3.0)
    assert (person.sample.hand.xyz == np.array(OVER_TABLE)).all()


def _straight(start: Array, goal: Array) -> JointTrajectory:
    """Return a motion of 1.6 s with minimum jerk."""
    s = np.linspace(0.0, 1.0, 161)[:, None]
    rate = 30.0 * s**2 * (1.0 - s) ** 2 / 1.6
    return JointTrajectory(
        dt_s=0.01,
        position_rad=start + (goal - start) * (10.0 * s**3 - 15.0 * s**4 + 6.0 * s**5),
        velocity_rad_s=(goal - start) * rate,
    )


def test_people_go_through_one_another() -> None:
    bob = PersonBody(name="bob", shoulder=(0.0, 0.75, 0.45), hand_rests=OVER_TABLE, upper_arm_m=0.5, forearm_m=0.5)
    scene = with_anna(one_arm())
    person = SteppedPerson(build_cell(msgspec.structs.replace(scene, people=(*scene.people, bob))))
    person.reach(OVER_TABLE)
    person.run(1.0)
    assert person.sample.hand.xyz == pytest.approx(OVER_TABLE)
    assert person.sample.count.contacts == 0
    assert person.snapshot().person("bob").count.contacts == 0


def test_a_part_is_pushed_along_as_fast_as_the_hand_moves(person: SteppedPerson) -> None:
    row = person.simulation.summary.frames.index("part")
    person.reach((0.0, -0.38, 0.02))
    person.run(1.0)
    person.reach((0.0, -0.13, 0.02), speed_m_s=0.4)
    person.run(person.sample.arrives_in_s + 0.5)
    # The ball of the hand has a radius of 5 cm, stops 13 cm before the middle, and is kept up by the table.
    y_m = person.snapshot().frames()[0][row][1]
    assert -0.09 < y_m < 0.1
    count = person.sample.count
    assert count.pairs == (("anna/hand", "part"),)
    assert count.contacts >= 1
    assert 0.2 < count.touching_s < 1.5


def test_an_arm_feels_the_push_and_the_contact_is_counted_by_names_time_and_force(person: SteppedPerson) -> None:
    """The hand pushes the arm at its hand towards +y: about the base that turns the first joint to the left."""
    assert person.sample.count.contacts == 0
    person.reach(AT_LEFT_HAND)
    person.run(2.0)
    count = person.sample.count
    assert count.contacts > 0
    assert {own for own, _ in count.pairs} <= {"anna/hand", "anna/forearm"}
    assert all(other.startswith("left/") for _, other in count.pairs)
    assert count.touching_s > 0.5
    assert count.greatest_force_n > 20.0
    sample = person.snapshot().arm("left")
    assert sample.external_nm[0] > 1.0
    person.reach(OVER_TABLE)
    person.run(2.0)
    after = person.sample.count
    assert np.abs(person.snapshot().arm("left").external_nm).max() < 0.5
    person.run(1.0)
    assert person.sample.count == after


def test_what_is_there_before_anything_moves_is_counted_and_stays_one_contact() -> None:
    """Resting in the way of nobody who moves: a hand that lies in an arm touches it all the time, once."""
    lying = msgspec.structs.replace(ANNA, shoulder=(-0.24, -0.5, 0.6), hand_rests=(-0.243, -0.07, 0.6))
    person = SteppedPerson(build_cell(with_anna(one_arm(), lying)))
    person.run(0.05)
    count = person.sample.count
    assert count.touching_s == pytest.approx(0.05)
    assert count.contacts >= len(count.pairs) >= 1


def test_equal_commands_give_equal_bits(cell: CellModel) -> None:
    def lived() -> tuple[str, bytes]:
        person = SteppedPerson(cell)
        person.reach(AT_LEFT_HAND, stay_s=0.1)
        person.run(1.1)
        person.reach(OVER_TABLE, speed_m_s=0.7)
        person.run(0.4)
        return person.simulation.state_hash(), _image(person)

    assert lived() == lived()


def test_an_image_holds_what_a_person_does_and_has_touched(cell: CellModel) -> None:
    """In mid-reach, with contacts behind it: two worlds that go on from there agree in every bit."""
    first = SteppedPerson(cell)
    first.reach(AT_LEFT_HAND, stay_s=0.05)
    first.run(1.0)
    image = np.zeros(first.simulation.image_layout.size)
    first.simulation.write_image(image)
    lost = first.sample

    def go_on(*, lived_before: bool) -> SteppedPerson:
        person = SteppedPerson(cell)
        if lived_before:
            person.reach(OVER_TABLE, stay_s=0.0)
            person.run(0.333)
        person.simulation.apply(RestoreWorld(image=image))
        assert person.sample.count == lost.count
        assert person.sample.arrives_in_s == lost.arrives_in_s
        assert (person.sample.hand.xyz == lost.hand.xyz).all()
        person.run(3.0)
        return person

    fresh, old = go_on(lived_before=False), go_on(lived_before=True)
    assert fresh.simulation.state_hash() == old.simulation.state_hash()
    assert _image(fresh) == _image(old)
    assert fresh.sample.hand.xyz == pytest.approx(REST)
    assert lost.count.contacts > 0


def _image(person: SteppedPerson) -> bytes:
    image = np.zeros(person.simulation.image_layout.size)
    person.simulation.write_image(image)
    return image.tobytes()
