"""One motion without a controller: when it has ended, and when it has not, by what is measured."""

from __future__ import annotations

import asyncio
from collections.abc import Awaitable, Callable

import numpy as np
import pytest

from engine.errors import RobotError
from robots.drivers.abb.abb_motion import AbbMeasurement, AbbMotion, MotionCommands
from robots.drivers.abb.motion_link import Done
from robots.port import Array, JointTrajectory, MotionEnd, Tolerance
from tests.robots.drivers.abb.emulated_irc5 import straight

START, GOAL = np.zeros(2), np.array([0.4, -0.2])
TOLERANCE = Tolerance(path_rad=0.1, goal_rad=0.01)


class Controller:
    """Takes downloads and stops; the test says when they are confirmed, and what is measured."""

    def __init__(self, trajectory: JointTrajectory) -> None:
        self.downloads: list[tuple[JointTrajectory, Done]] = []
        self.stops: list[Done] = []
        self.now_s = 0.0
        self.panel_speed = 1.0
        self.motion = AbbMotion(
            trajectory,
            MotionCommands(self._download, self._stop),
            joint_names=("joint_1", "joint_2"),
            tolerance=TOLERANCE,
            speed=lambda: 1.0,
            panel_speed=lambda: self.panel_speed,
        )

    async def confirm(self) -> None:
        """Confirm the last download."""
        self.downloads[-1][1].set_result(self.now_s)
        await asyncio.wait((self.downloads[-1][1],))

    async def confirm_stop(self) -> None:
        """Confirm the last stop request."""
        self.stops[-1].set_result(self.now_s)
        await asyncio.wait((self.stops[-1],))

    def measure(self, position: Array, *, in_motion: bool = False, times: int = 1) -> None:
        """Let the motion have measurements, a tenth of a second apart."""
        for _ in range(times):
            self.now_s += 0.1
            self.motion.take(AbbMeasurement(asked_s=self.now_s, position_rad=position, in_motion=in_motion))

    def _download(self, trajectory: JointTrajectory) -> tuple[Done, float]:
        done: Done = asyncio.get_running_loop().create_future()
        self.downloads.append((trajectory, done))
        return done, trajectory.duration_s

    def _stop(self) -> Done:
        done: Done = asyncio.get_running_loop().create_future()
        self.stops.append(done)
        return done


def run(scenario: Callable[[Controller], Awaitable[None]], trajectory: JointTrajectory | None = None) -> None:
    """Execute a scenario on a motion from START to GOAL in two seconds, or along another trajectory."""

    async def execute() -> None:
        await scenario(Controller(trajectory or straight(START, GOAL, duration_s=2.0)))

    asyncio.run(execute())


def there_and_back() -> JointTrajectory:
    """A path that ends where it begins."""
    there = straight(START, GOAL, duration_s=1.0).position_rad
    position = np.vstack((there, there[::-1]))
    return JointTrajectory(dt_s=0.01, position_rad=position, velocity_rad_s=np.zeros_like(position))


def test_a_path_that_ends_where_it_begins_has_not_ended_before_the_arm_has_moved() -> None:
    async def scenario(controller: Controller) -> None:
        await controller.confirm()
        controller.measure(START, times=5)
        assert not controller.motion.ended
        for position in there_and_back().position_rad[10:195:10]:
            controller.measure(position, in_motion=True)
        controller.measure(START)
        assert not controller.motion.ended
        controller.measure(START)
        assert controller.motion.result is not None
        assert controller.motion.result.end is MotionEnd.REACHED

    run(scenario, there_and_back())


def test_rest_elsewhere_is_no_end_and_becomes_a_failure() -> None:
    async def scenario(controller: Controller) -> None:
        await controller.confirm()
        controller.measure(0.2 * GOAL, in_motion=True)
        controller.measure(0.3 * GOAL, times=15)
        assert (controller.motion.ended, controller.stops) == (False, [])
        controller.measure(0.3 * GOAL, times=10)
        await controller.confirm_stop()
        controller.measure(0.3 * GOAL, times=2)
        report = await controller.motion.report()
        assert (report.end, report.at_rest) == (MotionEnd.FAILED, True)
        assert report.reason == "not at target: the arm rests, joint_1 is 0.280 rad from it"

    run(scenario)


def test_a_measurement_from_before_the_stop_was_confirmed_is_no_rest() -> None:
    async def scenario(controller: Controller) -> None:
        await controller.confirm()
        controller.measure(0.3 * GOAL, in_motion=True)
        controller.motion.cancel()
        controller.measure(0.3 * GOAL, times=3)
        assert not controller.motion.ended
        await controller.confirm_stop()
        controller.measure(0.35 * GOAL, in_motion=True)
        controller.measure(0.36 * GOAL)
        assert not controller.motion.ended
        controller.measure(0.36 * GOAL)
        assert (await controller.motion.report()).end is MotionEnd.CANCELED

    run(scenario)


def test_a_stop_that_is_not_confirmed_says_that_the_robot_may_move() -> None:
    async def scenario(controller: Controller) -> None:
        await controller.confirm()
        controller.motion.cancel()
        controller.stops[-1].set_exception(RobotError("controller silent: no reply within 1 s"))
        report = await controller.motion.report()
        assert (report.end, report.at_rest) == (MotionEnd.FAILED, False)
        assert report.reason == (
            "the stop request failed: controller silent: no reply within 1 s; the robot may still be moving"
        )

    run(scenario)


def test_an_arm_that_moves_on_after_a_stop_is_not_at_rest() -> None:
    async def scenario(controller: Controller) -> None:
        await controller.confirm()
        controller.motion.cancel()
        await controller.confirm_stop()
        controller.measure(0.3 * GOAL, in_motion=True, times=60)
        report = await controller.motion.report()
        assert (report.end, report.at_rest) == (MotionEnd.FAILED, False)
        assert "it still moves 5 s after the stop request" in report.reason

    run(scenario)


@pytest.mark.parametrize("passed", [0.3, 0.7])
def test_what_is_left_begins_at_the_measured_position(passed: float) -> None:
    async def scenario(controller: Controller) -> None:
        await controller.confirm()
        for share in np.arange(0.1, passed + 0.05, 0.1):
            controller.measure(share * GOAL, in_motion=True)
        holding = asyncio.ensure_future(controller.motion.hold())
        while not controller.stops:
            await asyncio.wait((holding,), timeout=0.0)
        await controller.confirm_stop()
        beside = passed * GOAL + 0.002
        controller.measure(beside, times=2)
        await holding
        resuming = asyncio.ensure_future(controller.motion.resume())
        while len(controller.downloads) < 2:
            await asyncio.wait((resuming,), timeout=0.0)
        rest = controller.downloads[-1][0].position_rad
        assert rest[0].tolist() == beside.tolist()
        assert rest[-1].tolist() == GOAL.tolist()
        assert np.all(rest[1:, 0] >= passed * GOAL[0] - 0.01)
        await controller.confirm()
        controller.measure(0.9 * GOAL, in_motion=True)
        await resuming
        controller.measure(GOAL, times=2)
        assert (await controller.motion.report()).end is MotionEnd.REACHED

    run(scenario)


def test_an_arm_off_its_path_is_stopped() -> None:
    async def scenario(controller: Controller) -> None:
        await controller.confirm()
        controller.measure(np.array([0.1, 0.2]), in_motion=True)
        await controller.confirm_stop()
        controller.measure(np.array([0.1, 0.2]), times=2)
        assert (await controller.motion.report()).reason.startswith("off the path: a joint is 0.2")

    run(scenario)


def test_a_download_after_the_stop_of_the_link_is_stopped_too() -> None:
    """The link stops while the event loop is blocked; a callback that waited there downloads the rest."""

    async def scenario(controller: Controller) -> None:
        await controller.confirm()
        controller.measure(START + 0.1, in_motion=True)
        controller.motion.change_speed()
        await controller.confirm_stop()
        controller.measure(START + 0.1, times=4)
        assert len(controller.downloads) == 2
        controller.motion.note_stop("engine silent")
        assert len(controller.stops) == 2
        await controller.confirm_stop()
        controller.measure(START + 0.1, times=4)
        report = await controller.motion.report()
        assert (report.end, report.reason, report.at_rest) == (MotionEnd.FAILED, "engine silent", True)

    run(scenario)


def test_a_cause_that_is_known_better_while_it_stops_is_the_reason() -> None:
    async def scenario(controller: Controller) -> None:
        await controller.confirm()
        controller.measure(0.3 * GOAL, in_motion=True)
        controller.motion.explain("before anything stops it")
        controller.motion.abort("drives off: the motors are off")
        controller.motion.explain("guard stop: a safeguard is open")
        await controller.confirm_stop()
        controller.measure(0.3 * GOAL, times=3)
        assert (await controller.motion.report()).reason == "guard stop: a safeguard is open"

    run(scenario)


def test_a_cancelled_motion_has_no_other_reason() -> None:
    async def scenario(controller: Controller) -> None:
        await controller.confirm()
        controller.measure(0.3 * GOAL, in_motion=True)
        controller.motion.cancel()
        controller.motion.explain("guard stop: a safeguard is open")
        await controller.confirm_stop()
        controller.measure(0.3 * GOAL, times=3)
        assert (await controller.motion.report()).end is MotionEnd.CANCELED

    run(scenario)


def test_a_motion_may_take_as_long_as_the_speed_of_the_panel_makes_it() -> None:
    async def scenario(controller: Controller) -> None:
        await controller.confirm()
        controller.panel_speed = 0.1
        controller.measure(0.3 * GOAL, in_motion=True, times=200)
        assert (controller.stops, controller.motion.ended) == ([], False)
        controller.panel_speed = 0.0
        controller.measure(0.3 * GOAL, times=200)
        assert (controller.stops, controller.motion.ended) == ([], False)
        controller.panel_speed = 1.0
        controller.measure(0.3 * GOAL, times=30)
        assert len(controller.stops) == 1

    run(scenario)
