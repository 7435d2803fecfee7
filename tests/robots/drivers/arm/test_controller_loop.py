"""The control loop of a real arm on a controller in memory: what it sends, when it gives up, and what it says of it."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from engine.skills.arm_control import ControlSettings
from robots.control.commanding.arm_commands import ConfigureArm, FollowTrajectory, StartGuiding
from robots.control.motion_event import AnyMotionEvent, MotionFinished
from robots.drivers.arm.controller_loop import NOT_ENABLED, ControllerLoop
from robots.drivers.arm.joint_controller import ControllerIdentity, ControllerLost, ControllerReading, MotionRefused
from robots.model.transform import RigidTransform
from robots.port import Array, MotionEnd, Tolerance
from tests.robots.drivers.arm_under_test import FAR, MODEL, NEAR, START
from tests.robots.sim.sim_cell import smooth

PERIOD_S = 0.008


class ControllerInMemory:
    """Implements `JointController`: the arm is at each set point one period later, unless it is stuck."""

    period_s = PERIOD_S

    def __init__(self) -> None:
        self.now_s = 0.0
        self.reading = ControllerReading(
            time_s=0.0, position_rad=START.copy(), velocity_rad_s=np.zeros(6), effort_nm=np.zeros(6)
        )
        self.sent: list[Array] = []
        self.tools: list[tuple[list[float], float]] = []
        self.is_stuck = self.is_silent = self.is_refusing = self.is_refusing_tools = False
        self.held_with_tool_rad: Array | None = None
        self.stops = 0
        self.invalid: dict[str, object] = {}

    def clock(self) -> float:
        return self.now_s

    def connect(self) -> ControllerIdentity:
        return ControllerIdentity()

    def enable(self, *, tcp_xyz_m: Array, load_kg: float, load_com_m: Array) -> None:
        if self.is_refusing_tools:
            raise MotionRefused("refused: setTcp was refused")
        self.tools.append((tcp_xyz_m.round(6).tolist(), load_kg))
        if self.held_with_tool_rad is not None:
            self.reading = replace(self.reading, held_rad=self.held_with_tool_rad)

    def read(self) -> ControllerReading | None:
        self.now_s += 2.0 * PERIOD_S if self.is_silent else PERIOD_S
        if self.is_silent:
            return None
        position = self.sent[-1] if self.sent and not self.is_stuck else self.reading.position_rad
        velocity = (position - self.reading.position_rad) / PERIOD_S
        self.reading = replace(self.reading, time_s=self.now_s, position_rad=position, velocity_rad_s=velocity)
        return replace(self.reading, **self.invalid)

    def command(self, position_rad: Array, velocity_rad_s: Array) -> None:
        if self.is_refusing:
            raise MotionRefused("program ended: a set point was not taken", hint="look at the log")
        self.sent.append(position_rad.copy())

    def stop(self) -> None:
        self.stops += 1

    def set_output(self, output: int, *, on: bool) -> None:
        """It has none."""

    @property
    def output_problem(self) -> str:
        return ""

    def close(self) -> None:
        """Nothing is open."""


class Arm:
    """A loop on such a controller, and the ends of its motions."""

    def __init__(self, controller: ControllerInMemory | None = None) -> None:
        self.controller = controller or ControllerInMemory()
        self.loop = ControllerLoop(
            name="arm",
            model=MODEL,
            base=RigidTransform.of((0.0, 0.0, 0.0), (0.0, 0.0, 0.0, 1.0)),
            controller=self.controller,
            gravity_m_s2=np.array((0.0, 0.0, -9.81)),
            stale_s=0.2,
            clock=self.controller.clock,
        )
        self.loop.read_first()
        self.ends: list[MotionFinished] = []

    def follow(self, goal: Array, duration_s: float = 1.0) -> None:
        start = self.loop.control.motion.position.copy()
        trajectory = smooth(start, goal, duration_s, limits=MODEL.limits)
        self.loop.take(FollowTrajectory(arm="arm", motion=1, trajectory=trajectory, tolerance=Tolerance()))

    def step(self, count: int) -> list[AnyMotionEvent]:
        events = [event for _ in range(count) for event in self.loop.step()]
        self.ends += [event for event in events if isinstance(event, MotionFinished)]
        return events

    def end(self) -> MotionFinished:
        for _ in range(5000):
            if self.ends:
                return self.ends.pop()
            self.step(1)
        raise AssertionError("the motion does not end")


@pytest.fixture
def arm() -> Arm:
    """Return an arm that may move."""
    made = Arm()
    made.loop.enable()
    return made


def test_a_motion_is_sent_as_set_points_within_the_limits_and_reaches_its_goal(arm: Arm) -> None:
    arm.follow(NEAR)
    assert arm.end().report.end is MotionEnd.REACHED
    sent = np.array(arm.controller.sent)
    assert sent[-1] == pytest.approx(NEAR)
    velocity = np.diff(sent, axis=0) / PERIOD_S
    assert (np.abs(velocity).max(axis=0) <= np.array(MODEL.limits.velocity_rad_s) * 1.001).all()
    assert arm.loop.at_rest


def test_nothing_is_sent_before_motion_is_enabled() -> None:
    arm = Arm()
    arm.follow(NEAR)
    report = arm.end().report
    assert (report.end, report.reason, report.at_rest) == (MotionEnd.FAILED, NOT_ENABLED, True)
    assert arm.controller.sent == []


def test_a_controller_that_slows_the_arm_down_stretches_the_motion(arm: Arm) -> None:
    arm.follow(NEAR)
    arm.end()
    full = len(arm.controller.sent)
    arm.controller.reading = replace(arm.controller.reading, speed_scaling=0.5)
    arm.follow(START)
    assert arm.end().report.end is MotionEnd.REACHED
    assert len(arm.controller.sent) - full > 1.6 * full


def test_a_motion_whose_arm_does_not_follow_fails_with_joint_and_amount(arm: Arm) -> None:
    arm.follow(FAR, 2.5)
    arm.step(20)
    arm.controller.is_stuck = True
    report = arm.end().report
    assert report.end is MotionEnd.FAILED
    assert report.reason.startswith("shoulder_pan_joint is 0.15")
    assert "behind its set point" in report.reason


def test_a_silent_controller_is_lost_and_its_motion_ends_with_the_cause(arm: Arm) -> None:
    arm.follow(FAR, 2.5)
    arm.step(20)
    sent = len(arm.controller.sent)
    arm.controller.is_silent = True
    with pytest.raises(ControllerLost, match="controller silent") as lost:
        arm.step(100)
    assert len(arm.controller.sent) == sent
    assert arm.controller.now_s < 20 * PERIOD_S + 0.3
    (event,) = arm.loop.abandon(str(lost.value))
    assert isinstance(event, MotionFinished)
    assert (event.motion, event.report.end, event.report.at_rest) == (1, MotionEnd.FAILED, False)
    assert event.report.reason.endswith("arm may still be moving")


def test_a_short_silence_only_delays_a_motion(arm: Arm) -> None:
    arm.follow(NEAR)
    for _ in range(10):
        arm.step(10)
        arm.controller.is_silent = True
        arm.step(5)
        arm.controller.is_silent = False
    assert arm.end().report.end is MotionEnd.REACHED


def test_a_stop_of_the_controller_ends_the_motion_at_rest_and_forbids_the_next(arm: Arm) -> None:
    arm.follow(FAR, 2.5)
    arm.step(80)
    arm.controller.is_stuck = True
    arm.controller.reading = replace(arm.controller.reading, stopped_by="protective stop: stopped", remedy="unlock it")
    report = arm.end().report
    assert (report.reason, report.at_rest) == ("protective stop: stopped", True)
    assert (arm.loop.problem, arm.loop.hint) == ("protective stop: stopped", "unlock it")
    with pytest.raises(MotionRefused, match="protective stop"):
        arm.loop.enable()
    arm.controller.reading = replace(arm.controller.reading, stopped_by="", remedy="")
    arm.step(1)
    assert arm.loop.problem == "protective stop: stopped"
    arm.controller.is_stuck = False
    arm.controller.sent.clear()
    arm.loop.enable()
    arm.follow(START)
    assert arm.end().report.end is MotionEnd.REACHED


def test_a_refused_set_point_ends_the_motion_and_stops_the_arm_by_the_second_path(arm: Arm) -> None:
    arm.follow(FAR, 2.5)
    arm.step(20)
    arm.controller.is_refusing = True
    assert arm.end().report.reason == "program ended: a set point was not taken"
    assert arm.controller.stops == 1


def test_tool_and_load_are_set_at_rest_and_the_controller_subtracts_the_load(arm: Arm) -> None:
    arm.follow(NEAR)
    arm.step(20)
    settings = ControlSettings(tool_xyz_m=(0.0, 0.0, 0.1), load_kg=2.0)
    arm.loop.take(ConfigureArm(arm="arm", settings=settings))
    arm.step(5)
    assert arm.controller.tools == [([0.0, 0.0, 0.0], 0.0)]
    arm.end()
    arm.step(2)
    assert arm.controller.tools[1:] == [([0.0, 0.0, 0.1], 2.0)]
    assert arm.loop.control.settings.load_kg == 0.0


def test_hand_guiding_is_refused_with_the_reason(arm: Arm) -> None:
    arm.loop.take(StartGuiding(arm="arm", motion=3, damping=0.0))
    assert "not guided by hand" in arm.end().report.reason


def test_braking_ends_a_motion_with_its_cause(arm: Arm) -> None:
    arm.follow(FAR, 2.5)
    arm.step(80)
    arm.loop.brake("STOP: a hand")
    report = arm.end().report
    assert (report.end, report.reason) == (MotionEnd.FAILED, "STOP: a hand; arm came to rest by itself")
    assert arm.loop.at_rest


def test_a_measured_wrench_is_turned_into_world_axes() -> None:
    arm = Arm()
    turned = ControllerLoop(
        name="arm",
        model=MODEL,
        base=RigidTransform.of((0.0, 0.0, 0.0), (0.0, 0.0, float(np.sqrt(0.5)), float(np.sqrt(0.5)))),
        controller=arm.controller,
        gravity_m_s2=np.zeros(3),
        stale_s=0.2,
        clock=arm.controller.clock,
    )
    arm.controller.reading = replace(arm.controller.reading, wrench=np.array((10.0, 0.0, 0.0, 0.0, 2.0, 0.0)))
    turned.read_first()
    for _ in range(20):
        turned.step()
    assert turned.state().sample.wrench == pytest.approx([0.0, 10.0, 0.0, -2.0, 0.0, 0.0], abs=1e-3)


def test_enabling_is_refused_while_a_motion_is_active_which_goes_on(arm: Arm) -> None:
    arm.follow(FAR, 2.5)
    arm.step(50)
    tools, sent = len(arm.controller.tools), arm.controller.sent[-1]
    with pytest.raises(MotionRefused, match="a motion is active"):
        arm.loop.enable()
    assert len(arm.controller.tools) == tools
    arm.step(1)
    assert np.abs(arm.controller.sent[-1] - sent).max() > 0.0
    assert arm.end().report.end is MotionEnd.REACHED


def test_enabling_is_refused_until_a_stopped_arm_is_measured_at_rest(arm: Arm) -> None:
    arm.follow(FAR, 2.5)
    arm.step(50)
    arm.controller.reading = replace(arm.controller.reading, stopped_by="protective stop")
    moving = arm.controller.sent[-1] + 0.01
    arm.controller.sent.append(moving)
    arm.step(1)
    arm.controller.reading = replace(arm.controller.reading, stopped_by="")
    with pytest.raises(MotionRefused, match="a motion is active"):
        arm.loop.enable()
    assert arm.end().report.at_rest
    arm.loop.enable()
    assert arm.loop.at_rest


def test_enabling_is_refused_while_another_program_moves_the_arm() -> None:
    arm = Arm()
    arm.controller.sent.append(START + 0.01)
    arm.step(1)
    with pytest.raises(MotionRefused, match="the arm moves"):
        arm.loop.enable()
    assert arm.controller.tools == []


def test_a_controller_that_goes_on_by_itself_gets_the_set_point_of_as_many_periods_later(arm: Arm) -> None:
    other = Arm()
    other.loop.enable()
    for each in (arm, other):
        each.follow(NEAR)
        each.step(20)
    arm.controller.reading = replace(arm.controller.reading, periods=3)
    arm.step(1)
    other.step(3)
    assert arm.controller.sent[-1] == pytest.approx(other.controller.sent[-1], abs=1e-9)
    assert len(other.controller.sent) - len(arm.controller.sent) == 2


def test_motion_starts_from_the_set_point_that_a_controller_holds() -> None:
    arm = Arm()
    held = START + 0.002
    arm.controller.reading = replace(arm.controller.reading, held_rad=held)
    arm.loop.enable()
    arm.controller.is_stuck = True
    arm.step(1)
    assert arm.controller.sent == [pytest.approx(held)]


def test_an_arm_whose_tool_is_refused_when_it_is_enabled_again_moves_no_more(arm: Arm) -> None:
    arm.controller.is_refusing_tools = True
    with pytest.raises(MotionRefused, match="setTcp was refused"):
        arm.loop.enable()
    assert (arm.loop.problem, arm.controller.stops) == ("refused: setTcp was refused", 1)
    arm.follow(NEAR)
    assert arm.end().report.reason == "refused: setTcp was refused"
    arm.controller.is_refusing_tools = False
    arm.loop.enable()
    assert arm.loop.problem == ""


def test_a_controller_that_stops_while_it_is_enabled_again_is_stopped_for_the_loop_too(arm: Arm) -> None:
    """It may say so once only."""
    arm.controller.reading = replace(arm.controller.reading, stopped_by="program paused: stopped")
    with pytest.raises(MotionRefused, match="program paused"):
        arm.loop.enable()
    arm.controller.reading = replace(arm.controller.reading, stopped_by="")
    sent = len(arm.controller.sent)
    arm.step(1)
    assert (arm.loop.problem, len(arm.controller.sent)) == ("program paused: stopped", sent)


def test_after_a_change_of_the_tool_motion_starts_from_the_set_point_that_the_controller_holds(arm: Arm) -> None:
    arm.controller.reading = replace(arm.controller.reading, held_rad=START)
    arm.step(1)
    settings = ControlSettings(tool_xyz_m=(0.0, 0.0, 0.1), load_kg=2.0)
    arm.loop.take(ConfigureArm(arm="arm", settings=settings))
    arm.controller.is_stuck = True
    arm.controller.held_with_tool_rad = START + 0.002
    arm.step(2)
    assert arm.controller.sent[-1] == pytest.approx(START + 0.002)


NAN = float("nan")


@pytest.mark.parametrize(
    ("invalid", "cause"),
    [
        ({"position_rad": np.array((0.0, 0.0, NAN, 0.0, 0.0, 0.0))}, "position of elbow_joint is nan rad"),
        (
            {"velocity_rad_s": np.array((0.0, np.inf, 0.0, 0.0, 0.0, 0.0))},
            "velocity of shoulder_lift_joint is inf rad/s",
        ),
        ({"effort_nm": np.full(6, NAN)}, "effort of shoulder_pan_joint is nan Nm"),
        ({"held_rad": np.full(6, NAN)}, "held set point of shoulder_pan_joint is nan rad"),
        ({"wrench": np.array((0.0, 0.0, 0.0, NAN, 0.0, 0.0))}, "wrench of torque x is nan"),
        ({"position_rad": np.zeros(5)}, "it has 5 values of position, expected 6"),
        ({"velocity_rad_s": np.zeros(7)}, "it has 7 values of velocity, expected 6"),
        ({"wrench": np.zeros(3)}, "it has 3 values of wrench, expected 6"),
        ({"time_s": NAN}, "time is nan"),
        ({"speed_scaling": NAN}, "speed scaling is nan"),
    ],
)
def test_a_reading_that_cannot_be_measured_ends_the_motion_and_goes_no_further(
    arm: Arm, invalid: dict[str, object], cause: str
) -> None:
    arm.follow(FAR, 2.5)
    arm.step(20)
    sent, before = len(arm.controller.sent), arm.loop.state()
    arm.controller.invalid = invalid
    with pytest.raises(ControllerLost) as lost:
        arm.step(1)
    assert str(lost.value).startswith(f"invalid reading of arm: {cause}")
    assert len(arm.controller.sent) == sent
    after = arm.loop.state()
    assert (after.readings, after.sample.time_s) == (before.readings, before.sample.time_s)
    assert after.sample.position_rad == pytest.approx(before.sample.position_rad)
    assert np.isfinite(arm.loop.control.motion.position).all()
    (event,) = arm.loop.abandon(str(lost.value))
    assert isinstance(event, MotionFinished)
    assert (event.motion, event.report.end) == (1, MotionEnd.FAILED)
    assert cause in event.report.reason


def test_an_arm_whose_first_reading_is_invalid_is_not_opened() -> None:
    arm = Arm()
    arm.controller.invalid = {"position_rad": np.full(6, NAN)}
    with pytest.raises(ControllerLost, match="position of shoulder_pan_joint is nan rad"):
        arm.loop.read_first()


def test_the_state_says_when_the_controller_has_tool_and_load(arm: Arm) -> None:
    """With them comes the set point from which the next motion has to start."""
    settings = ControlSettings(tool_xyz_m=(0.0, 0.0, 0.1), load_kg=2.0)
    assert arm.loop.state().has_settings(ControlSettings())
    arm.loop.take(ConfigureArm(arm="arm", settings=settings))
    assert not arm.loop.state().has_settings(settings)
    arm.controller.held_with_tool_rad = START + 0.002
    arm.controller.reading = replace(arm.controller.reading, held_rad=START)
    arm.step(1)
    state = arm.loop.state()
    assert state.has_settings(settings)
    assert state.sample.desired_rad == pytest.approx(START + 0.002)


def test_a_tool_that_the_controller_refuses_is_not_said_to_be_there(arm: Arm) -> None:
    settings = ControlSettings(load_kg=2.0)
    arm.controller.is_refusing_tools = True
    arm.loop.take(ConfigureArm(arm="arm", settings=settings))
    arm.step(1)
    assert not arm.loop.state().has_settings(settings)


def test_a_load_that_is_set_in_a_motion_waits_for_its_end(arm: Arm) -> None:
    settings = ControlSettings(load_kg=2.0)
    arm.follow(NEAR)
    arm.step(5)
    arm.loop.take(ConfigureArm(arm="arm", settings=settings))
    assert arm.loop.state().has_settings(settings)
    arm.end()
    arm.step(1)
    assert arm.loop.state().tool[0] == 2.0
