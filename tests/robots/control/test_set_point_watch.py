"""The watch of set points: what it reports, what it passes over, and how an arm that may not jump stops instead."""

from __future__ import annotations

import logging
from dataclasses import dataclass, field

import numpy as np
import pytest

from robots.control.arm_control_loop import ArmControlLoop
from robots.control.generators.joint_jogging import JointJogGenerator
from robots.control.motion_event import AnyMotionEvent, MotionFinished, SetPointJumped
from robots.control.set_point_watch import SetPointWatch
from robots.port import Array, MotionEnd, Tolerance
from tests.robots.control.limit_watch import STEP_S, limits
from tests.robots.panda_arm import home, panda_kinematics, panda_model

JOINTS = ("shoulder", "elbow")


@dataclass
class SetPoint:
    """A set point that a test moves."""

    position: Array = field(default_factory=lambda: np.zeros(2))
    velocity: Array = field(default_factory=lambda: np.zeros(2))
    number: int = 7
    leads: bool = True
    generator_name: str = "rest"


def watched() -> tuple[SetPointWatch, SetPoint]:
    """Return a watch, and a set point at zero that it has seen."""
    watch, point = SetPointWatch(arm="left", joints=JOINTS, limits=limits()), SetPoint()
    watch.restart(point.position)
    assert watch.look(STEP_S, point) is None
    return watch, point


@pytest.mark.jumps
@pytest.mark.parametrize(
    ("moved_rad", "quantity", "message"),
    [
        (2.5, "position", "position of elbow 2.5 rad, limit 2"),
        (0.01, "velocity", "velocity of elbow 10 rad/s, limit 2.002"),
        (1e-3, "acceleration", "acceleration of elbow 1000 rad/s², limit 15.3"),
        (1e-5, "jerk", "jerk of elbow 1e+04 rad/s³, limit 2200"),
    ],
)
def test_a_jump_says_which_joint_exceeds_which_limit_when_and_between_which_generators(
    moved_rad: float, quantity: str, message: str
) -> None:
    watch, point = watched()
    point.position[1] = moved_rad
    point.generator_name = "trajectory"
    jump = watch.look(STEP_S, point)
    assert jump is not None
    assert (jump.motion, jump.arm, jump.before, jump.generator, jump.quantity) == (
        7,
        "left",
        "rest",
        "trajectory",
        quantity,
    )
    assert jump.reason == f"the set point of left jumped at 0.002 s (rest → trajectory): {message}"


@pytest.mark.jumps
@pytest.mark.parametrize("sign", [-1.0, 1.0])
def test_a_set_point_may_be_at_a_limit_of_its_joint_and_not_beyond(sign: float) -> None:
    watch, point = watched()
    point.position = np.array([0.0, sign * 2.0])
    watch.restart(point.position)
    point.position = point.position + np.array([0.0, sign * 1e-6])
    assert watch.look(STEP_S, point) is None
    point.position = point.position + np.array([0.0, sign * 2e-6])
    jump = watch.look(STEP_S, point)
    assert jump is not None
    assert jump.quantity == "position"


def test_a_set_point_that_starts_anew_has_only_the_velocity_that_it_is_given() -> None:
    watch, point = watched()
    watch.restart(point.position, np.ones(2))
    watch.restart(point.position)
    assert watch.look(STEP_S, point) is None
    watch.restart(point.position, np.ones(2))
    point.position = point.position + STEP_S
    assert watch.look(STEP_S, point) is None


@pytest.mark.jumps
@pytest.mark.parametrize(("periods", "count"), [(1, 1), (6, 1), (7, 2)])
def test_a_second_jump_counts_when_the_first_one_is_past(periods: int, count: int) -> None:
    watch, point = watched()
    for period in range(periods + 1):
        if period in (0, periods):
            point.position = point.position + 0.01
        watch.look(STEP_S, point)
    assert watch.count == count


@pytest.mark.jumps
def test_a_jump_that_is_not_sent_leaves_the_past_as_it_was() -> None:
    watch, point = watched()
    point.position[1] = 0.01
    assert watch.look(STEP_S, point) is not None
    assert not watch.reject().any()
    point.position[1] = 0.0
    assert watch.look(STEP_S, point) is None
    point.position[1] = 0.01
    again = watch.look(STEP_S, point)
    assert again is not None
    assert "jumped at 0.003 s" in again.reason
    assert watch.count == 2


@pytest.mark.jumps
def test_a_jump_after_a_change_of_generators_names_both_for_four_periods() -> None:
    named: list[str] = []
    for periods in range(6):
        watch, point = watched()
        point.generator_name = "trajectory"
        for _ in range(periods):
            assert watch.look(STEP_S, point) is None
        point.position[1] = 0.01
        jump = watch.look(STEP_S, point)
        assert jump is not None
        assert jump.ratio == pytest.approx(10.0 / 2.002)
        named.append(jump.before)
    assert named == ["rest"] * 4 + ["trajectory"] * 2


@pytest.mark.jumps
def test_one_jump_is_reported_once_and_the_next_one_again(caplog: pytest.LogCaptureFixture) -> None:
    watch, point = watched()
    for jump in (0.01, 0.01):
        point.position = point.position + jump
        for _ in range(10):
            watch.look(STEP_S, point)
    assert watch.count == 2
    assert [record.levelno for record in caplog.records] == [logging.WARNING] * 2


def test_a_set_point_that_follows_the_arm_is_compared_with_nothing_until_it_leads_again() -> None:
    watch, point = watched()
    point.leads = False
    for _ in range(10):
        point.position = point.position + 0.001
        point.velocity[:] = 1.0
        assert watch.look(STEP_S, point) is None
    point.leads = True
    point.position = point.position + 0.001
    assert watch.look(STEP_S, point) is None


@pytest.mark.jumps
def test_no_number_is_a_jump_too() -> None:
    watch, point = watched()
    point.position[0] = np.nan
    jump = watch.look(STEP_S, point)
    assert jump is not None
    assert "position of shoulder nan rad" in jump.reason


def test_a_joint_beyond_its_range_may_come_back_or_stay() -> None:
    watch, point = watched()
    point.position = np.array([2.1, 0.0])
    watch.restart(point.position)
    for moved in (0.0, -1e-9, -3e-9, -6e-9):
        point.position = np.array([2.1 + moved, 0.0])
        assert watch.look(STEP_S, point) is None


class JumpingJog(JointJogGenerator):
    """A generator with a fault: after 200 periods its set point is elsewhere for ever."""

    periods = 0

    def _go(self, step_s: float, *, pace: float, state: object) -> None:
        self._shaper.run(step_s, velocity=self._received * pace)
        self.periods += 1
        if self.periods >= 200:
            self.position += 0.05


@pytest.mark.jumps
def test_an_arm_that_may_not_jump_brakes_from_its_last_set_point_and_fails_with_the_cause() -> None:
    model = panda_model()
    control = ArmControlLoop(
        name="left", kinematics=panda_kinematics(), gravity_m_s2=np.zeros(3),
        touching=lambda: "", on_jump="stop",
    )  # fmt: skip
    control.initialize(home())
    jog = JumpingJog(limits=model.limits, start=home(), watchdog_s=10.0)
    control.start(1, jog, Tolerance())
    control.motion.receive(1, np.full(7, 0.5))
    sent, velocity = [home()] * 3, np.zeros(7)
    events: list[AnyMotionEvent] = []
    for _ in range(1500):
        control.measure(sent[-1], velocity, wrench=np.zeros(6), step_s=STEP_S)
        events.extend(control.advance(STEP_S))
        sent.append(control.motion.position.copy())
        velocity = (sent[-1] - sent[-2]) / STEP_S
    (jump,) = (event for event in events if isinstance(event, SetPointJumped))
    (end,) = (event for event in events if isinstance(event, MotionFinished))
    assert jump.quantity == "velocity"
    assert (end.report.end, end.report.reason) == (MotionEnd.FAILED, jump.reason)
    speed = np.diff(np.array(sent), axis=0) / STEP_S
    assert np.abs(speed).max() <= 0.5 + 1e-6
    change = np.diff(speed, axis=0) / STEP_S
    assert (np.abs(change) <= np.array(model.limits.acceleration_rad_s2)).all()
    assert (np.abs(np.diff(change, axis=0)) / STEP_S <= np.array(model.limits.jerk_rad_s3) * 1.1).all()
    assert not speed[-100:].any()
