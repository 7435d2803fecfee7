"""Measures of an arm that only publishes: what is known of its motion comes out, what it does not say is missing."""

from __future__ import annotations

import pytest

from engine.bus import SkillBus
from engine.clock import new_clock
from engine.measures import TopicMeasures
from engine.messages import Message
from tests.engine.measures.published_arm import RADIUS_M, RATE_RAD_S, describe, place, press, turn


class Battery(Message, frozen=True, kw_only=True):
    """A topic of a device that happens to have the name of one of ours."""

    level: float


pytestmark = pytest.mark.virtual


async def test_an_arm_that_publishes_everything_has_all_but_its_tracking_error() -> None:
    """Two seconds at a known rate: as a circle and an angle say."""
    bus = SkillBus(new_clock())
    measures = TopicMeasures(["left"])
    describe(bus)
    measures.listen(bus)
    for step in range(201):
        turn(bus, step / 100)
        place(bus, step / 100)
        press(bus, 5.0 if step == 77 else 1.0, 0.3)
    found = measures.measures()
    assert found == {
        "left.path_m": pytest.approx(RADIUS_M * RATE_RAD_S * 2.0, rel=0.02),
        "left.joint_path_rad": pytest.approx(RATE_RAD_S * 2.0, rel=0.02),
        "left.speed_max_m_s": pytest.approx(RADIUS_M * RATE_RAD_S, rel=1e-3),
        "left.force_max_n": pytest.approx(5.0),
        "left.torque_max_nm": pytest.approx(0.3),
    }


async def test_what_is_not_published_is_missing() -> None:
    """Joints only give the path of the joints; force sensors and other devices are no arms."""
    bus = SkillBus(new_clock())
    measures = TopicMeasures()
    measures.listen(bus)
    bus.topic("cart/status", Battery).publish(Battery(level=0.5))
    press(bus, 5.0, 0.3, "table")
    turn(bus, 0.0)
    turn(bus, 1.0)
    place(bus, 1.0)
    assert measures.measures() == {"left.joint_path_rad": pytest.approx(RATE_RAD_S)}


async def test_noise_of_a_fast_topic_is_no_path() -> None:
    """Of 1,000 messages in a second, one in 25 ms counts."""
    bus = SkillBus(new_clock())
    measures = TopicMeasures()
    measures.listen(bus)
    describe(bus)
    for step in range(1001):
        turn(bus, step / 1000, noise_rad=1e-3 * (-1) ** step)
    assert measures.measures()["left.joint_path_rad"] == pytest.approx(RATE_RAD_S, abs=0.09)


async def test_the_tool_centre_point_counts_and_another_one_is_no_movement() -> None:
    """It is 0.1 m farther out than the tool link."""
    bus = SkillBus(new_clock())
    measures = TopicMeasures()
    measures.listen(bus)
    describe(bus, tool_xyz_m=(0.1, 0.0, 0.0))
    for step in range(26):
        place(bus, step / 25)
    assert measures.measures()["left.path_m"] == pytest.approx((RADIUS_M + 0.1) * RATE_RAD_S, rel=1e-3)
    before = measures.measures()
    describe(bus, tool_xyz_m=(0.0, 0.0, 0.7))
    place(bus, 1.04)
    assert measures.measures() == before


async def test_a_device_whose_clock_begins_again_has_not_moved() -> None:
    """It was connected again: what it did in between is not known."""
    bus = SkillBus(new_clock())
    measures = TopicMeasures()
    measures.listen(bus)
    describe(bus)
    for time_s in (2.0, 2.1, 0.0, 0.1):
        turn(bus, time_s)
        place(bus, time_s)
    found = measures.measures()
    assert found["left.joint_path_rad"] == pytest.approx(0.2 * RATE_RAD_S)
    assert found["left.path_m"] == pytest.approx(0.2 * RATE_RAD_S * RADIUS_M, rel=1e-3)
    assert found["left.speed_max_m_s"] == pytest.approx(RATE_RAD_S * RADIUS_M, rel=1e-3)


async def test_who_no_longer_listens_asks_for_nothing() -> None:
    """Publishers build no messages for it any more."""
    bus = SkillBus(new_clock())
    measures = TopicMeasures()
    end = measures.listen(bus)
    describe(bus)
    turn(bus, 0.0)
    assert bus.find_topic("left/joint_state").subscriber_count == 1
    end()
    turn(bus, 1.0)
    assert bus.find_topic("left/joint_state").subscriber_count == 0
    assert measures.measures() == {"left.joint_path_rad": 0.0}
