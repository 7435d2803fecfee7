"""How an arm's motion is judged, on an arm that is made to lag, to be stuck, or to follow perfectly."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest

from robots.control.generators.guarded_motion import GuardedMotion
from robots.control.generators.trajectory_playback import TrajectoryPlayback
from robots.control.motion_event import AnyMotionEvent, MotionFinished, MotionHeld, MotionResumed
from robots.control.motion_executor import MotionExecutor
from robots.port import Array, ContactCondition, JointTrajectory, MotionEnd, MotionReport, Tolerance
from tests.robots.control.limit_watch import limits
from tests.robots.control.plane_arm import plane_state

START = np.zeros(2)


def ramp(goal: Array) -> JointTrajectory:
    """Return a minimum-jerk motion of half a second from zero."""
    u = np.linspace(0.0, 1.0, 501)[:, None]
    return JointTrajectory(
        dt_s=0.001,
        position_rad=goal * (10 * u**3 - 15 * u**4 + 6 * u**5),
        velocity_rad_s=goal * (30 * u**2 - 60 * u**3 + 30 * u**4) / 0.5,
    )


def run(
    motion: MotionExecutor, measure: Callable[[Array], Array], *, limit: int = 6000, moving: bool = False
) -> tuple[list[AnyMotionEvent], int]:
    """Step until something happens; `measure` makes the measured joints of the set point."""
    position = measure(motion.position)
    for step in range(limit):
        before, position = position, measure(motion.position)
        velocity = np.full(2, 0.5) if moving else (position - before) / 0.001
        events = list(motion.step(0.001, plane_state(position, velocity)))
        position = measure(motion.position)
        if events:
            return events, step
    return [], limit


def new_motion(
    goal: Array, tolerance: Tolerance, *, contact: str = "", settling: Callable[[], bool] = lambda: False
) -> MotionExecutor:
    """Return an arm's motions with number 7 under way."""
    motion = MotionExecutor(joints=("shoulder", "elbow"), limits=limits(), touching=lambda: contact, settling=settling)
    motion.initialize(START)
    motion.start(
        7,
        TrajectoryPlayback(ramp(goal), acceleration_rad_s2=np.full(2, 10.0), jerk_rad_s3=np.full(2, 1000.0)),
        tolerance,
    )
    return motion


def test_an_arm_that_follows_reaches_its_goal() -> None:
    events, steps = run(new_motion(np.array([0.2, 0.1]), Tolerance()), lambda desired: desired.copy())
    assert events == [MotionFinished(motion=7, progress=1.0, report=MotionReport(end=MotionEnd.REACHED))]
    assert 490 <= steps < 560


def test_a_stuck_arm_fails_naming_the_worst_joint_and_the_contact() -> None:
    motion = new_motion(np.array([0.3, 0.9]), Tolerance(path_rad=0.1), contact="left hand touches part box")
    events, _ = run(motion, lambda _: START)
    (end,) = events
    assert isinstance(end, MotionFinished)
    assert end.report.end == MotionEnd.FAILED
    assert end.report.reason.startswith("elbow is 0.10")
    assert end.report.reason.endswith("rad behind its set point; left hand touches part box")
    assert motion.position == pytest.approx(START, abs=1e-9)
    assert motion.number == 0


def test_an_arm_that_stays_off_its_goal_fails_after_the_settling_time() -> None:
    motion = new_motion(np.array([0.2, 0.1]), Tolerance(goal_rad=0.01, settle_s=0.5))
    events, steps = run(motion, lambda desired: desired * 0.9)
    (end,) = events
    assert isinstance(end, MotionFinished)
    assert end.report.reason == "shoulder is 0.020 rad away from the goal after 0.5 s"
    assert 1000 <= steps < 1200


@pytest.mark.parametrize(
    ("behind_rad", "is_settling", "waits_s"),
    [(0.002, True, 0.3), (0.002, False, 0.0), (0.0004, True, 0.0)],
    ids=["behind", "friction holds it", "in position"],
)
def test_an_arm_behind_its_goal_gets_a_while_as_long_as_its_controller_brings_it_nearer(
    *, behind_rad: float, is_settling: bool, waits_s: float
) -> None:
    tolerance = Tolerance(in_position_rad=0.0005, in_position_s=0.3)
    motion = new_motion(np.array([0.2, 0.1]), tolerance, settling=lambda: is_settling)
    events, steps = run(motion, lambda desired: desired - behind_rad)
    assert events == [MotionFinished(motion=7, progress=1.0, report=MotionReport(end=MotionEnd.REACHED))]
    assert steps * 0.001 == pytest.approx(0.5 + waits_s, abs=0.002)


def test_an_arm_has_reached_its_goal_as_soon_as_its_controller_has_brought_it_there() -> None:
    is_settling = True
    motion = new_motion(np.array([0.2, 0.1]), Tolerance(in_position_s=0.3), settling=lambda: is_settling)
    assert run(motion, lambda desired: desired - 0.002, limit=600) == ([], 600)
    is_settling = False
    events, steps = run(motion, lambda desired: desired - 0.002)
    assert (len(events), steps) == (1, 0)


def test_after_a_contact_nothing_is_left_to_reach() -> None:
    """What presses back holds the arm behind its set point."""
    trajectory = TrajectoryPlayback(
        ramp(np.array([0.2, 0.1])), acceleration_rad_s2=np.full(2, 10.0), jerk_rad_s3=np.full(2, 1000.0)
    )
    motion = MotionExecutor(joints=("shoulder", "elbow"), limits=limits(), touching=lambda: "", settling=lambda: True)
    motion.initialize(START)
    motion.start(7, GuardedMotion(trajectory, ContactCondition(force_n=5.0)), Tolerance(in_position_s=0.3))
    events: list[AnyMotionEvent] = []
    for step in range(450):
        state = plane_state(motion.position - 0.002, np.zeros(2))
        state.wrench[2] = 10.0 if step > 200 else 0.0
        events.extend(motion.step(0.001, state))
    (end,) = events
    assert isinstance(end, MotionFinished)
    assert (end.report.end, end.report.contact) == (MotionEnd.REACHED, True)


def test_an_arm_that_never_rests_is_not_called_cancelled() -> None:
    motion = new_motion(np.array([0.2, 0.1]), Tolerance())
    motion.cancel(7)
    events, steps = run(motion, lambda desired: desired.copy(), moving=True)
    (end,) = events
    assert isinstance(end, MotionFinished)
    assert (end.report.end, end.report.reason) == (MotionEnd.FAILED, "the arm does not come to rest")
    assert steps >= 3000


def test_what_is_stopped_for_a_cause_brakes_on_its_path_and_fails_with_that_cause() -> None:
    motion = new_motion(np.array([0.2, 0.1]), Tolerance())
    assert run(motion, lambda desired: desired.copy(), limit=100) == ([], 100)
    motion.stop("the engine was silent")
    motion.stop("the engine was silent for longer")
    motion.cancel(7)
    events, _ = run(motion, lambda desired: desired.copy())
    (end,) = events
    assert isinstance(end, MotionFinished)
    assert (end.report.end, end.report.reason, 0.0 < end.progress < 1.0) == (
        MotionEnd.FAILED,
        "the engine was silent",
        True,
    )
    assert motion.position[0] == 2.0 * motion.position[1]


def test_what_is_being_cancelled_already_stays_so() -> None:
    motion = new_motion(np.array([0.2, 0.1]), Tolerance())
    motion.cancel(7)
    motion.stop("the engine was silent")
    events, _ = run(motion, lambda desired: desired.copy())
    assert events == [MotionFinished(motion=7, progress=0.0, report=MotionReport(end=MotionEnd.CANCELED))]


def test_commands_for_another_motion_are_ignored() -> None:
    motion = new_motion(np.array([0.2, 0.1]), Tolerance())
    motion.cancel(6)
    motion.hold(8)
    events, _ = run(motion, lambda desired: desired.copy())
    assert events == [MotionFinished(motion=7, progress=1.0, report=MotionReport(end=MotionEnd.REACHED))]


def test_a_hold_is_not_confirmed_while_the_arm_still_moves() -> None:
    motion = new_motion(np.array([0.2, 0.1]), Tolerance())
    motion.hold(7)
    assert run(motion, lambda desired: desired.copy(), limit=1500, moving=True)[0] == []
    assert run(motion, lambda desired: desired.copy())[0] == [MotionHeld(motion=7)]


def test_an_arm_that_is_initialized_forgets_its_motion_and_holds_the_position() -> None:
    motion = new_motion(np.array([0.2, 0.1]), Tolerance())
    run(motion, lambda desired: desired.copy(), limit=200)
    motion.initialize(np.array([0.3, 0.4]))
    assert (motion.number, motion.position.tolist(), motion.velocity.tolist()) == (0, [0.3, 0.4], [0.0, 0.0])
    assert run(motion, lambda desired: desired.copy(), limit=1000)[0] == []


def test_of_a_hold_and_a_resume_the_latest_is_reported_with_its_number() -> None:
    motion = new_motion(np.array([0.2, 0.1]), Tolerance())
    motion.hold(7, request=1)
    motion.resume(7, request=2)
    motion.hold(7, request=3)
    assert run(motion, lambda desired: desired.copy())[0] == [MotionHeld(motion=7, request=3)]
    motion.resume(7, request=4)
    assert run(motion, lambda desired: desired.copy())[0] == [MotionResumed(motion=7, request=4)]
