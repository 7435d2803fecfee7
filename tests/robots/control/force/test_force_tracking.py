"""A tool that wipes along a spring wall while it presses: steadiness, stability, learning, holds, limits."""

from __future__ import annotations

import math

import numpy as np
import pytest

from engine.skills.dmp import Compliance
from robots.control.arm_state import ArmState
from robots.control.force.force_tracking import ForceTracking
from robots.control.motion_event import AnyMotionEvent, MotionFinished
from robots.control.motion_executor import MotionExecutor
from robots.port import Array, ForceRecord, ForceTask, JointTrajectory, MotionEnd, Tolerance
from tests.robots.control.limit_watch import STEP_S, LimitWatch, limits
from tests.robots.control.plane_arm import plane_state
from tests.robots.control.spring_wall import Wall, WallRig
from tests.robots.panda_arm import home, panda_kinematics
from tests.tiers import nightly

FORCE_N = 10.0
LEFT_M, RIGHT_M, WALL_M = 0.3, 0.6, 0.5
PRESS_Y = Compliance(active=(0.0, 1.0, 0.0, 0.0, 0.0, 0.0))


def joints_at(x_m: float, y_m: float) -> Array:
    """Return the elbow-up joints of the plane arm for a tip."""
    elbow = -math.acos((x_m * x_m + y_m * y_m - 0.5) / 0.5)
    shoulder = math.atan2(y_m, x_m) - math.atan2(0.5 * math.sin(elbow), 0.5 + 0.5 * math.cos(elbow))
    return np.array([shoulder, elbow])


def wipe(duration_s: float, *, y_m: float = WALL_M) -> JointTrajectory:
    """Return the way along y = 0.5 m from x = 0.3 to 0.6 m, minimum jerk."""
    u = np.linspace(0.0, 1.0, round(duration_s / 0.01) + 1)
    along = 10 * u**3 - 15 * u**4 + 6 * u**5
    position = np.array([joints_at(LEFT_M + (RIGHT_M - LEFT_M) * share, y_m) for share in along])
    velocity = np.gradient(position, 0.01, axis=0)
    velocity[[0, -1]] = 0.0
    return JointTrajectory(dt_s=0.01, position_rad=position, velocity_rad_s=velocity)


def task(
    duration_s: float = 4.0,
    *,
    admittance: Compliance = PRESS_Y,
    slow_per_n: float = 0.0,
    offset: Array | None = None,
    y_m: float = WALL_M,
) -> ForceTask:
    """Return the task to press on the wall with 10 N: it pushes back along -y."""
    trajectory = wipe(duration_s, y_m=y_m)
    samples = len(trajectory.position_rad)
    wrench = np.zeros((samples, 6))
    wrench[:, 1] = -FORCE_N
    return ForceTask(
        trajectory=trajectory,
        offset=np.zeros((samples, 6)) if offset is None else offset,
        wrench=wrench,
        admittance=admittance,
        slow_per_n=slow_per_n,
    )


def tracking(of: ForceTask) -> ForceTracking:
    return ForceTracking(of, limits=limits(), joints=("shoulder", "elbow"))


def straight(x_m: float) -> float:
    return WALL_M


def wavy(x_m: float) -> float:
    """Return a surface that the nominal path does not know: +-1 cm in waves of half a metre."""
    return WALL_M + 0.01 * math.sin(12.0 * (x_m - LEFT_M))


def error(bench: WallRig, start: int, end: int) -> Array:
    return -np.array(bench.forces[start:end]) - FORCE_N


@pytest.mark.parametrize("stiffness_n_m", [1000.0, 5000.0, 20000.0])
def test_along_a_straight_wall_the_force_is_steady_within_a_tenth_of_a_newton(stiffness_n_m: float) -> None:
    bench = WallRig(tracking(task()), Wall(stiffness_n_m, straight))
    bench.run()
    settled = 2600 if stiffness_n_m < 5000.0 else 800
    assert np.abs(error(bench, settled, 4000)).max() < 0.1


@pytest.mark.parametrize(
    ("stiffness_n_m", "delay"),
    [(1000.0, 20), nightly(5000.0, 20), nightly(10000.0, 20), nightly(20000.0, 15), (40000.0, 5)],
)
def test_default_gains_are_stable_on_soft_and_stiff_surfaces_for_an_arm_that_lags(
    stiffness_n_m: float, delay: int
) -> None:
    bench = WallRig(tracking(task()), Wall(stiffness_n_m, wavy), delay=delay)
    bench.run()
    # What remains is the slope of the surface against the damping of the admittance, no oscillation.
    steepest_m_s = 0.3 * 1.875 / 4.0 * 0.12
    assert np.abs(error(bench, 1000, 4000)).max() < 1.2 * steepest_m_s * 300.0
    assert np.abs(np.diff(np.array(bench.forces[1000:4000]))).max() < 0.1


def test_each_pass_with_the_offsets_of_the_one_before_presses_better() -> None:
    offset: Array | None = None
    rms: list[float] = []
    for _ in range(3):
        generator = tracking(task(offset=offset))
        bench = WallRig(generator, Wall(5000.0, wavy), delay=5, noise_n=0.15)
        bench.run()
        rms.append(float(np.sqrt(np.mean(error(bench, 500, 4000) ** 2))))
        offset = learned(ForceRecord.from_bytes(generator.data()), samples=401)
    assert rms[1] < 0.25 * rms[0]
    assert rms[2] < 0.8 * rms[1]
    assert rms[2] < 0.25


def learned(record: ForceRecord, *, samples: int) -> Array:
    """Return the offsets of a pass, smoothed over a tenth of a second."""
    window = np.hanning(13) / np.hanning(13).sum()
    share = np.linspace(0.0, 1.0, samples)
    columns = [np.convolve(np.pad(column, 6, mode="edge"), window, "valid") for column in record.offsets().T]
    return np.stack([np.interp(share, record.shares(), column) for column in columns], axis=1)


def test_the_record_tells_share_offset_and_wrench_in_the_task_frame() -> None:
    generator = tracking(task())
    bench = WallRig(generator, Wall(5000.0, straight))
    bench.run()
    record = ForceRecord.from_bytes(generator.data())
    assert len(record.shares()) in (400, 401)
    assert np.all(np.diff(record.shares()) > 0.0)
    assert record.shares()[[0, -1]] == pytest.approx([0.0014, 0.9986], abs=3e-3)
    assert record.offsets()[-1, 1] == pytest.approx(FORCE_N / 5000.0, abs=2e-5)
    assert record.wrenches()[-1, 1] == pytest.approx(-FORCE_N, abs=0.1)


def test_a_turned_task_frame_presses_along_its_own_axis() -> None:
    # The task's z axis is the world's -y: the wall pushes along +z of the task.
    turned = task(admittance=Compliance())
    wrench = np.zeros_like(turned.wrench)
    wrench[:, 2] = FORCE_N
    half = math.sqrt(0.5)
    generator = tracking(
        ForceTask(trajectory=turned.trajectory, offset=turned.offset, wrench=wrench, task_xyzw=(half, 0.0, 0.0, half))
    )
    bench = WallRig(generator, Wall(5000.0, straight))
    bench.run()
    assert np.abs(error(bench, 800, 4000)).max() < 0.1
    assert ForceRecord.from_bytes(generator.data()).offsets()[-1, 2] == pytest.approx(-0.002, abs=2e-5)


def test_the_first_learned_offset_is_faded_in_without_a_jump() -> None:
    offset = np.zeros((401, 6))
    offset[:, 1] = 0.002
    generator = tracking(task(offset=offset))
    bench = WallRig(generator, Wall(5000.0, straight))
    watch = LimitWatch(limits(), generator, jerk=False)
    for _ in range(1000):
        bench.step()
        watch.look()
    assert np.abs(np.array(watch.accelerations)).max() < 8.0
    assert abs(error(bench, 999, 1000)[0]) < 0.1


def test_held_it_keeps_pressing_as_it_is_and_does_not_go_after_a_wall_that_leaves() -> None:
    surface = [WALL_M]
    bench = WallRig(tracking(task()), Wall(5000.0, lambda x: surface[0]))
    for _ in range(2000):
        bench.step()
    for _ in range(400):
        bench.step(pace=0.0)
    assert bench.generator.stopped
    assert not bench.generator.moving
    assert abs(error(bench, 2399, 2400)[0]) < 0.5
    resting = bench.tips[-1]
    surface[0] += 0.02
    for _ in range(500):
        bench.step(pace=0.0)
    assert np.abs(bench.tips[-1] - resting).max() < 1e-5
    surface[0] = WALL_M
    for _ in range(1200):
        bench.step()
    assert bench.generator.moving
    assert abs(error(bench, 4099, 4100)[0]) < 0.1


def test_held_it_gives_way_to_a_wall_that_comes_nearer() -> None:
    surface = [WALL_M]
    bench = WallRig(tracking(task()), Wall(5000.0, lambda x: surface[0]))
    for _ in range(1500):
        bench.step()
    for step in range(1500):
        surface[0] = WALL_M - 0.01 * min(1.0, step / 1000)
        bench.step(pace=0.0)
    # 10 mm of a 5000 N/m wall would add 50 N.
    assert -bench.forces[-1] < FORCE_N + 1.2


@pytest.mark.parametrize("surface_m", [WALL_M, WALL_M + 1.0])
def test_cancelled_it_is_at_rest_within_a_third_of_a_second_in_contact_and_without(surface_m: float) -> None:
    generator = tracking(task())
    bench = WallRig(generator, Wall(5000.0, lambda x: surface_m))
    watch = LimitWatch(limits(), generator, jerk=False)
    for _ in range(1300):
        bench.step()
        watch.look()
    assert not generator.stopped
    steps = 0
    while not generator.stopped:
        bench.step(pace=0.0)
        watch.look()
        steps += 1
    assert steps < 330


def test_at_the_end_it_stands_on_the_offset_path_and_still_presses() -> None:
    generator = tracking(task())
    bench = WallRig(generator, Wall(5000.0, straight))
    bench.run()
    assert generator.progress == 1.0
    assert np.allclose(bench.tips[-1][:2], [RIGHT_M, WALL_M + FORCE_N / 5000.0], atol=2e-5)
    assert generator.goal is None


def test_without_a_wall_the_offset_ends_at_its_reach() -> None:
    bench = WallRig(
        tracking(task(admittance=Compliance(active=PRESS_Y.active, reach_m=0.02))), Wall(5000.0, lambda x: 9.0)
    )
    bench.run()
    assert bench.tips[-1][1] == pytest.approx(WALL_M + 0.02, abs=1e-4)
    assert max(tip[1] for tip in bench.tips) < WALL_M + 0.0201


def test_phase_stopping_takes_longer_where_the_force_is_wrong_and_presses_better() -> None:
    plain, slow = (WallRig(tracking(task(slow_per_n=value)), Wall(5000.0, wavy)) for value in (0.0, 1.0))
    plain.run()
    slow.run()
    assert len(slow.forces) > 1.2 * len(plain.forces)
    assert np.abs(error(slow, 800, len(slow.forces))).max() < 0.8 * np.abs(error(plain, 800, 4000)).max()


def test_a_speed_override_slows_the_path_and_not_the_force() -> None:
    bench = WallRig(tracking(task(duration_s=2.0)), Wall(5000.0, straight))
    bench.run(pace=0.25)
    assert 7900 < len(bench.forces) < 8100
    assert np.abs(error(bench, 800, 7900)).max() < 0.1


def pulled() -> ForceTracking:
    """Return a task that nothing pushes back at along x: the offset pulls the tool to the shoulder's limit."""
    away = Compliance(active=(1.0, 1.0, 0.0, 0.0, 0.0, 0.0), reach_m=0.3, touch_m_s=0.1)
    plain = task(admittance=away)
    wrench = np.zeros_like(plain.wrench)
    wrench[:, 0] = 30.0
    return tracking(ForceTask(trajectory=plain.trajectory, offset=plain.offset, wrench=wrench, admittance=away))


def test_a_joint_at_its_limit_ends_it_with_its_name() -> None:
    generator = pulled()
    bench = WallRig(generator, Wall(5000.0, lambda x: 9.0))
    watch = LimitWatch(limits(), generator, jerk=False)
    while not (generator.failure and generator.stopped):
        bench.step(pace=0.0 if generator.failure else 1.0)
        watch.look()
        assert len(bench.forces) < 4000
    assert generator.failure == (
        "the tool cannot follow the force-controlled path, error 20 mm and 0.00 rad: "
        "shoulder is at its position limit 2.000 rad"
    )


def test_the_motion_then_ends_as_failed_with_these_words() -> None:
    generator = pulled()
    motion = MotionExecutor(joints=("shoulder", "elbow"), limits=limits(), touching=lambda: "", settling=lambda: False)
    motion.initialize(generator.position)
    motion.start(1, generator, Tolerance())
    events: tuple[AnyMotionEvent, ...] = ()
    while not events:
        events = motion.step(STEP_S, plane_state(motion.position, motion.velocity))
    (end,) = events
    assert isinstance(end, MotionFinished)
    assert (end.report.end, end.report.reason) == (MotionEnd.FAILED, generator.failure)
    assert len(ForceRecord.from_bytes(end.report.data).shares()) > 10


def test_a_panda_presses_down_on_a_table_and_keeps_its_orientation() -> None:
    kinematics = panda_kinematics()
    state = ArmState(kinematics)
    start = kinematics.tool_pose(home())
    u = np.linspace(0.0, 1.0, 201)
    swing = (10 * u**3 - 15 * u**4 + 6 * u**5)[:, None]
    rate = ((30 * u**2 - 60 * u**3 + 30 * u**4) / 2.0)[:, None]
    turn = np.array([0.3, 0.0, 0.0, 0.0, 0.0, 0.0, 0.3])
    wrench = np.zeros((201, 6))
    wrench[:, 2] = FORCE_N
    generator = ForceTracking(
        ForceTask(
            trajectory=JointTrajectory(dt_s=0.01, position_rad=home() + swing * turn, velocity_rad_s=rate * turn),
            offset=np.zeros((201, 6)),
            wrench=wrench,
        ),
        limits=kinematics.limits,
        joints=kinematics.model.arm_joints,
    )
    forces: list[float] = []
    worst_rad = 0.0
    while not generator.complete:
        tool = kinematics.tool_pose(generator.position)
        state.refill(generator.position, generator.velocity)
        state.wrench[2] = max(0.0, 5000.0 * (start.xyz[2] - float(tool.xyz[2])))
        forces.append(float(state.wrench[2]))
        nominal = kinematics.tool_pose(home() + turn * _share_at(len(forces) * STEP_S / 2.0))
        worst_rad = max(worst_rad, tool.angle_rad(nominal))
        generator.step(STEP_S, target_pace=1.0, state=state)
    assert np.abs(np.array(forces[600:]) - FORCE_N).max() < 0.1
    assert worst_rad < 2e-3


def _share_at(passed: float) -> float:
    u = min(1.0, passed)
    return 10 * u**3 - 15 * u**4 + 6 * u**5


@pytest.mark.parametrize("after", ["cancelled", "at its end"])
def test_a_tool_that_is_pushed_on_and_on_comes_to_rest_within_two_seconds(after: str) -> None:
    """Nothing holds the force up, so giving way would never end by itself."""
    generator = tracking(task(0.5, admittance=Compliance(active=PRESS_Y.active, reach_m=1.0)))
    state, motion = (
        plane_state(),
        MotionExecutor(joints=("shoulder", "elbow"), limits=limits(), touching=lambda: "", settling=lambda: False),
    )
    motion.initialize(generator.position)
    motion.start(1, generator, Tolerance())
    state.wrench[1] = -25.0
    events: list[AnyMotionEvent] = []
    steps = 100 if after == "cancelled" else 500
    for step in range(steps + 2000):
        if step == steps and after == "cancelled":
            motion.cancel(1)
        state.refill(motion.position, motion.velocity)
        events.extend(motion.step(STEP_S, state))
        if events:
            break
    (end,) = events
    assert isinstance(end, MotionFinished)
    assert end.report.end == (MotionEnd.CANCELED if after == "cancelled" else MotionEnd.REACHED)
