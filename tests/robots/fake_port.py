"""An arm and a gripper without physics: they follow perfectly, in the time of the event loop."""

from __future__ import annotations

import asyncio

import numpy as np

from engine.errors import RobotError
from robots.port import (
    ArmSample,
    Array,
    GripperSample,
    JointTrajectory,
    Motion,
    MotionEnd,
    MotionReport,
    Tolerance,
)

STOPPING_S = 0.1


class FakeMotion:
    """A motion that takes `duration_s` of loop time and can be held, resumed, cancelled and made to fail."""

    def __init__(self, duration_s: float) -> None:
        self._loop = asyncio.get_running_loop()
        self._duration_s = duration_s
        self._passed_s = 0.0
        self._since_s = self._loop.time()
        self._end: asyncio.Future[MotionReport] = self._loop.create_future()
        self._timer: asyncio.TimerHandle | None = None
        self._run()

    @property
    def passed_s(self) -> float:
        """How much of its own time has passed."""
        running = self._timer is not None and not self._end.done()
        passed = self._passed_s + (self._loop.time() - self._since_s if running else 0.0)
        return min(passed, self._duration_s)

    @property
    def progress(self) -> float:
        """Share of its time passed."""
        return self.passed_s / self._duration_s if self._duration_s > 0.0 else 1.0

    @property
    def ended(self) -> bool:
        """True once it has a report."""
        return self._end.done()

    async def report(self) -> MotionReport:
        """Wait for the end."""
        return await asyncio.shield(self._end)

    async def hold(self) -> None:
        """Freeze."""
        self._freeze()

    async def resume(self) -> None:
        """Go on."""
        if self._timer is None:
            self._run()

    def cancel(self) -> None:
        """End as canceled a little later."""
        self._freeze()
        self._loop.call_later(STOPPING_S, self._finish, MotionEnd.CANCELED, "")

    def fail(self, reason: str) -> None:
        """End as failed now."""
        self._freeze()
        self._finish(MotionEnd.FAILED, reason)

    def _run(self) -> None:
        self._since_s = self._loop.time()
        self._timer = self._loop.call_later(self._duration_s - self._passed_s, self._arrive)

    def _arrive(self) -> None:
        self._passed_s, self._timer = self._duration_s, None
        self._finish(MotionEnd.REACHED, "")

    def _freeze(self) -> None:
        self._passed_s = self.passed_s
        if self._timer is not None:
            self._timer.cancel()
            self._timer = None

    def _finish(self, end: MotionEnd, reason: str) -> None:
        if not self._end.done():
            self._end.set_result(MotionReport(end=end, reason=reason))


class FakeArmPort:
    """Implements `ArmPort`: the joints are where the trajectory says."""

    def __init__(self, names: tuple[str, ...], position: Array, *, velocity_rad_s: float = 0.0) -> None:
        self._names = names
        self._position = position.copy()
        self._velocity = np.full(len(names), velocity_rad_s)
        self._trajectory: JointTrajectory | None = None
        self.motion: FakeMotion | None = None
        self.followed: list[JointTrajectory] = []

    @property
    def joint_names(self) -> tuple[str, ...]:
        """Names in order."""
        return self._names

    def sample(self) -> ArmSample:
        """Where the arm is now; measured and desired are the same."""
        position = self._present()
        return ArmSample(
            time_s=asyncio.get_running_loop().time(),
            position_rad=position,
            velocity_rad_s=self._velocity,
            effort_nm=np.zeros(len(position)),
            desired_rad=position,
        )

    def follow(self, trajectory: JointTrajectory, *, tolerance: Tolerance) -> Motion:
        """Start following; raises RobotError while another motion runs."""
        if self.motion is not None and not self.motion.ended:
            raise RobotError("another motion is under way", where="fake arm")
        assert np.abs(trajectory.position_rad[0] - self._present()).max() < 0.01
        self._trajectory = trajectory
        self.followed.append(trajectory)
        self.motion = FakeMotion((len(trajectory.position_rad) - 1) * trajectory.dt_s)
        return self.motion

    def _present(self) -> Array:
        if self._trajectory is None or self.motion is None:
            return self._position
        way = self._trajectory
        index = min(self.motion.passed_s / way.dt_s, len(way.position_rad) - 1.0)
        below = int(index)
        above = min(below + 1, len(way.position_rad) - 1)
        return way.position_rad[below] + (index - below) * (way.position_rad[above] - way.position_rad[below])


class FakeGripperPort:
    """Implements `GripperPort`: the fingers stop at `obstacle_m` when closing, if something is there."""

    max_width_m = 0.08

    def __init__(
        self,
        *,
        obstacle_m: float | None = None,
        contacts: tuple[str, str] = ("part", "part"),
        force_share: float = 1.0,
        opens_to_m: float = 0.08,
    ) -> None:
        self._obstacle_m = obstacle_m
        self._contacts = contacts
        self._force_share = force_share
        self._opens_to_m = opens_to_m
        self._way_m = (0.08, 0.08)
        self._force_n = 0.0
        self.motion: FakeMotion | None = None

    def lose_the_part(self) -> None:
        """Let what is held slip away; the fingers close on nothing."""
        self._obstacle_m = None
        self._way_m = (0.0, 0.0)

    def sample(self) -> GripperSample:
        """Where the fingers are and what the pads touch."""
        width = self._width_m()
        touching = self._obstacle_m is not None and width <= self._obstacle_m
        return GripperSample(
            time_s=asyncio.get_running_loop().time(),
            width_m=width,
            velocity_m_s=0.0,
            force_n=self._force_n * self._force_share if touching else 0.0,
            contacts=self._contacts if touching else ("", ""),
        )

    def close_to(self, *, width_m: float, speed_m_s: float, force_n: float) -> Motion:
        """Move the fingers."""
        start, goal = self._width_m(), width_m
        if width_m < start and self._obstacle_m is not None:
            goal = max(width_m, self._obstacle_m)
        if width_m > start:
            goal = min(width_m, self._opens_to_m)
        self._way_m, self._force_n = (start, goal), force_n
        self.motion = FakeMotion(abs(goal - start) / speed_m_s)
        return self.motion

    def _width_m(self) -> float:
        start, goal = self._way_m
        return goal if self.motion is None else start + self.motion.progress * (goal - start)
