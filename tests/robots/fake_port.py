"""An arm and a gripper without physics: they follow perfectly, in the time of the event loop."""

from __future__ import annotations

import asyncio
import math
from collections.abc import Callable

import numpy as np

from engine.errors import RobotError
from engine.skills.arm_control import ControlSettings
from robots.port import (
    ArmSample,
    Array,
    ContactCondition,
    ForceRecord,
    ForceTask,
    GripperSample,
    JointTrajectory,
    Motion,
    MotionEnd,
    MotionReport,
    StreamKind,
    Tolerance,
)

STOPPING_S = 0.1


class FakeMotion:
    """A motion that takes `duration_s` of loop time and can be held, resumed, cancelled and made to fail."""

    def __init__(self, duration_s: float, *, data: bytes = b"") -> None:
        self._loop = asyncio.get_running_loop()
        self._duration_s = duration_s
        self._data = data
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

    @property
    def running(self) -> bool:
        """False while it is frozen by a hold or a cancel."""
        return self._timer is not None

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

    def touch(self) -> None:
        """End as reached now, by a contact."""
        self._freeze()
        if not self._end.done():
            self._end.set_result(MotionReport(end=MotionEnd.REACHED, contact=True, data=self._data))

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
            self._end.set_result(MotionReport(end=end, reason=reason, data=self._data))


class FakeStream(FakeMotion):
    """Implements `Stream`: it lasts until it is finished or cancelled; keeps what it was `sent`, and how old it was."""

    def __init__(self, width: int, *, take: Callable[[tuple[float, ...]], None]) -> None:
        self._width = width
        self._take = take
        self.sent: list[tuple[float, ...]] = []
        self.ages_s: list[float] = []
        super().__init__(math.inf)

    @property
    def progress(self) -> float:
        """There is no way to speak of."""
        return 0.0

    def send(self, values: tuple[float, ...], *, age_s: float = 0.0) -> None:
        """Keep what was said, and its age; raises RobotError for a wrong number of values or one that is not finite."""
        if len(values) != self._width or not np.isfinite(values).all():
            raise RobotError(f"{values} cannot be sent", where="fake arm", hint=f"send {self._width} finite numbers")
        self.sent.append(values)
        self.ages_s.append(age_s)
        self._take(values)

    def finish(self) -> None:
        """End as reached a little later."""
        self._freeze()
        self._loop.call_later(STOPPING_S, self._finish, MotionEnd.REACHED, "")

    def _run(self) -> None:
        self._since_s = self._loop.time()


class FakeArmPort:
    """Implements `ArmPort`: the joints are where the trajectory, the stream or the hand of the test says.

    `touch_after_s` lets guarded motions meet something, `force_record` is what force tracking
    reports, `external_nm` and `wrench` are measured; `motion` is what runs or ran last.
    """

    def __init__(self, names: tuple[str, ...], position: Array, *, velocity_rad_s: float = 0.0) -> None:
        self._names = names
        self._position = position.copy()
        self._velocity = np.full(len(names), velocity_rad_s)
        self._trajectory: JointTrajectory | None = None
        self._stretch = 1.0
        self._reflex = ""
        self._reflex_listeners: list[Callable[[str], None]] = []
        self.settings = ControlSettings()
        self.motion: FakeMotion | None = None
        self.followed: list[JointTrajectory] = []
        self.contacts: list[ContactCondition | None] = []
        self.touch_after_s: float | None = None
        self.tracked: list[ForceTask] = []
        self.force_record = ForceRecord.of(share=np.array([0.0, 1.0]), offset=np.zeros((2, 6)), wrench=np.zeros((2, 6)))
        self.streamed: list[tuple[StreamKind, float]] = []
        self.guided: list[float] = []
        self.external_nm = np.zeros(len(names))
        self.wrench = np.zeros(6)

    @property
    def joint_names(self) -> tuple[str, ...]:
        """Names in order."""
        return self._names

    @property
    def reflex_reason(self) -> str:
        """Why it was tripped, until it is recovered."""
        return self._reflex

    def when_reflex(self, callback: Callable[[str], None]) -> None:
        """Call `callback` when it is tripped."""
        self._reflex_listeners.append(callback)

    def sample(self) -> ArmSample:
        """Where the arm is now; measured and desired are the same."""
        position = self._present()
        return ArmSample(
            time_s=asyncio.get_running_loop().time(),
            position_rad=position,
            velocity_rad_s=self._velocity,
            effort_nm=np.zeros(len(position)),
            desired_rad=position,
            external_nm=self.external_nm,
            wrench=self.wrench,
            reflex=bool(self._reflex),
        )

    def follow(
        self, trajectory: JointTrajectory, *, tolerance: Tolerance, until: ContactCondition | None = None
    ) -> Motion:
        """Start following; raises RobotError while another motion runs or a reflex is not recovered from."""
        self._check_free()
        motion = self._play(trajectory)
        self.followed.append(trajectory)
        self.contacts.append(until)
        if until is not None and self.touch_after_s is not None:
            asyncio.get_running_loop().call_later(self.touch_after_s, motion.touch)
        return motion

    def track_force(self, task: ForceTask, *, tolerance: Tolerance) -> Motion:
        """Follow the nominal path and report `force_record`."""
        self._check_free()
        self.tracked.append(task)
        return self._play(task.trajectory, data=self.force_record.to_bytes())

    def stream(self, kind: StreamKind, *, watchdog_s: float) -> FakeStream:
        """Start a stream; of `joint_position` the arm is at once where it is told, others do not move it."""
        self._check_free()
        self.streamed.append((kind, watchdog_s))
        take = self.lead_to if kind == "joint_position" else _ignore
        return self._start_stream(FakeStream(6 if kind == "tool_twist" else len(self._names), take=take))

    def guide(self, *, damping: float = 0.0) -> FakeStream:
        """Float; the test leads the arm by `lead_to`."""
        self._check_free()
        self.guided.append(damping)
        return self._start_stream(FakeStream(0, take=_ignore))

    def lead_to(self, joints: tuple[float, ...]) -> None:
        """Put the arm there."""
        self._position, self._trajectory = np.array(joints), None

    def configure(self, settings: ControlSettings) -> None:
        """Take the settings; raises RobotError for wrong numbers of joints, a senseless tool, or no speed override."""
        if not (np.isfinite(settings.tool_xyz_m).all() and abs(math.hypot(*settings.tool_xyzw) - 1.0) < 1e-3):
            raise RobotError(f"the tool cannot be at {settings.tool_xyz_m}, {settings.tool_xyzw}", where="fake arm")
        if not np.isfinite((*settings.tool_xyz_m, settings.load_kg)).all() or max(map(abs, settings.tool_xyz_m)) > 2.0:
            raise RobotError("a value is out of its range", where="fake arm")
        per_joint = (settings.joint_stiffness_nm_rad, settings.collision_torque_nm)
        if any(values and len(values) != len(self._names) for values in per_joint):
            raise RobotError("there is not one value a joint", where="fake arm")
        if not 0.0 < settings.speed_override <= 1.0:
            raise RobotError(f"speed_override cannot be {settings.speed_override}", where="fake arm")
        self.settings = settings

    def trip(self, reason: str) -> None:
        """Let the arm stop by itself."""
        self._reflex = reason
        for tell in self._reflex_listeners:
            tell(reason)
        if self.motion is not None and not self.motion.ended:
            self.motion.fail(reason)

    def recover(self) -> None:
        """End a reflex."""
        self._reflex = ""

    def _check_free(self) -> None:
        if self._reflex:
            raise RobotError(
                f"the arm has stopped by itself: {self._reflex}", where="fake arm", hint="recover it first"
            )
        if self.motion is not None and not self.motion.ended:
            raise RobotError("another motion is active", where="fake arm")

    def _play(self, trajectory: JointTrajectory, *, data: bytes = b"") -> FakeMotion:
        assert np.abs(trajectory.position_rad[0] - self._present()).max() < 0.01
        self._trajectory = trajectory
        duration_s = trajectory.duration_s / self.settings.speed_override
        self._stretch = self.settings.speed_override
        self.motion = FakeMotion(duration_s, data=data)
        return self.motion

    def _start_stream(self, stream: FakeStream) -> FakeStream:
        self._position, self._trajectory = self._present().copy(), None
        self.motion = stream
        return stream

    def _present(self) -> Array:
        if self._trajectory is None or self.motion is None:
            return self._position
        way = self._trajectory
        index = min(self.motion.passed_s * self._stretch / way.dt_s, len(way.position_rad) - 1.0)
        below = int(index)
        above = min(below + 1, len(way.position_rad) - 1)
        return way.position_rad[below] + (index - below) * (way.position_rad[above] - way.position_rad[below])


def _ignore(values: tuple[float, ...]) -> None:
    """Let `values` have no effect."""


class FakeGripperPort:
    """Implements `GripperPort`: the fingers stop at `obstacle_m` when closing, if something is there."""

    max_width_m = 0.08
    max_force_n = 140.0

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
