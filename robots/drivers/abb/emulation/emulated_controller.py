"""The emulated controller: what its motion server, motion task and safety do, over a clock."""

from __future__ import annotations

import logging
import math
from collections.abc import Callable

import numpy as np

from robots.drivers.abb.emulation.joint_path import InterpolatedPath
from robots.drivers.abb.simple_message import (
    END_DOWNLOAD,
    JOINTS,
    START_DOWNLOAD,
    STOP,
    JointPosition,
    OperatingMode,
    RobotStatus,
    TrajectoryPoint,
    Tristate,
)
from robots.drivers.emulation.kinematic_joints import KinematicJoints
from robots.drivers.emulation.plant import ArmPlant
from robots.port import Array

MOST_POINTS = 100
AXES = 6
MOTION_SUPERVISION = 50204
"""Event of a controller whose axes do not follow."""
# The motion task looks for a new trajectory that often.
_THROTTLE_S = 0.05
_NEAR_RAD = math.radians(0.1)
_FASTEST_RAD_S = np.array([3.05, 3.05, 3.05, 4.36, 4.36, 6.28])
_FURTHEST_RAD = 7.0
_log = logging.getLogger("flexcell.emulator")


class EmulatedController:
    """An IRC5 with the programs of abb_driver; `now_s` is its clock, `plant` has its axes.

    Attributes:
        axes: Set points of the axes.
        warnings: What the FlexPendant shows, oldest first.
        stop_requests: When a stop request arrived, on its clock.
        started: Number of trajectories that have begun.
        rested_s: When the axes last came to rest.
    """

    def __init__(
        self,
        now_s: Callable[[], float],
        *,
        axes: Array,
        stop_s: float,
        plant: ArmPlant | None = None,
        load_kg: float = 0.0,
    ) -> None:
        self.now_s = now_s
        self.plant: ArmPlant = plant or KinematicJoints(axes)
        self.axes = self.plant.measured()[0].copy()
        self._load_kg = load_kg
        self._stop_s = stop_s
        self.warnings: list[str] = []
        self.stop_requests: list[float] = []
        self.started = 0
        self.rested_s = 0.0
        self.travel_rad = 0.0
        self.e_stopped = False
        self.drives_on = True
        self.mode = OperatingMode.AUTO
        self.program_runs = True
        self.error_code = 0
        self.unknown = False
        self.speed_share = 1.0
        # Whether guided motion moves the axes.
        self.guided = False
        self._points: list[TrajectoryPoint] = []
        self._pending: tuple[float, list[TrajectoryPoint]] | None = None
        self._path: InterpolatedPath | None = None
        self._path_s = 0.0
        self._rate = 0.0
        self._clear_at_rest = False
        self._time_s = now_s()

    @property
    def may_move(self) -> bool:
        """Whether the motion task runs and the drives are on."""
        return (
            self.drives_on
            and not self.e_stopped
            and self.program_runs
            and self.mode is OperatingMode.AUTO
            and not self.error_code
        )

    @property
    def downloaded(self) -> int:
        """Number of points of a download that is not complete."""
        return len(self._points)

    @property
    def in_motion(self) -> bool:
        """Whether the axes move."""
        return self.guided or (self._path is not None and self._rate > 0.0 and self.speed_share > 0.0)

    def take(self, point: TrajectoryPoint) -> None:
        """Execute a message of the motion server."""
        self.advance()
        if point.sequence == STOP:
            self.stop_requests.append(self.now_s())
            self._points, self._pending = [], None
            self._abort()
            return
        if point.sequence == START_DOWNLOAD:
            self._points = []
        if len(self._points) < MOST_POINTS:
            self._points.append(point)
        else:
            self._warn(f"too many trajectory points: {MOST_POINTS} at most, a further one was dropped")
        if point.sequence == END_DOWNLOAD:
            self._pending = (self.now_s() + _THROTTLE_S, self._points)
            self._points = []
            self._abort()

    def forget_download(self) -> None:
        """Drop a download that was not completed: the motion server has restarted."""
        self._points = []

    def forget_path(self) -> None:
        """Forget the path and what waits: the program begins at main."""
        self.advance()
        self._path, self._pending, self._rate, self._clear_at_rest = None, None, 0.0, False

    def switch_off(self) -> None:
        """Restart: the drives are off, the programs run again, nothing is left of a path."""
        self.advance()
        self.drives_on = False
        self._path, self._pending, self._points, self._rate = None, None, [], 0.0

    def go_on(self) -> None:
        """Do what an operator does: release and close everything, and start the program, which continues its path."""
        self.advance()
        self.e_stopped, self.drives_on, self.program_runs = False, True, True
        self.mode, self.error_code, self.unknown = OperatingMode.AUTO, 0, False
        if self.plant.problem:
            self.plant.reset()
            self.axes = self.plant.measured()[0].copy()

    def joint_position(self) -> JointPosition:
        """Return the measurement."""
        self.advance()
        return JointPosition(sequence=0, joints_rad=(*self.plant.measured()[0].tolist(), *(0.0,) * (JOINTS - AXES)))

    def status(self) -> RobotStatus:
        """Return the status."""
        self.advance()
        if self.unknown:
            nothing = Tristate.UNKNOWN
            return RobotStatus(
                drives_powered=nothing,
                e_stopped=nothing,
                error_code=0,
                in_error=nothing,
                in_motion=nothing,
                mode=OperatingMode.UNKNOWN,
                motion_possible=nothing,
            )
        runs = self.program_runs and self.mode is OperatingMode.AUTO
        return RobotStatus(
            drives_powered=Tristate(int(self.drives_on and not self.e_stopped)),
            e_stopped=Tristate(int(self.e_stopped)),
            error_code=self.error_code,
            in_error=Tristate(int(self.error_code != 0)),
            in_motion=Tristate(int(self.in_motion)),
            mode=self.mode,
            motion_possible=Tristate(int(runs and self.drives_on and not self.e_stopped)),
        )

    def advance(self) -> None:
        """Move the axes up to now."""
        now_s = self.now_s()
        while self._time_s < now_s:
            step_s = min(0.01, now_s - self._time_s)
            self._time_s += step_s
            self._step(step_s)
        self._move_plant()

    def _move_plant(self) -> None:
        """Send the set points to the axes; motion supervision stops what does not follow."""
        self.plant.carry(self._load_kg)
        self.plant.follow(self.axes, np.zeros(AXES))
        if self.plant.problem and not self.error_code:
            self._warn(f"motion supervision: {self.plant.problem}")
            self.error_code, self.program_runs = MOTION_SUPERVISION, False
            self._path, self._pending, self._rate, self._clear_at_rest = None, None, 0.0, False

    def _step(self, step_s: float) -> None:
        if self._path is not None and self._path_s < self._path.duration_s:
            braking = self._clear_at_rest or not self.may_move
            ending_rate = max(0.0, self._rate - step_s / self._stop_s) if braking else 1.0
            along_s = 0.5 * (self._rate + ending_rate) * step_s if braking else step_s
            self._path_s += along_s * self.speed_share
            was_moving, self._rate = self._rate > 0.0, ending_rate
            before, self.axes = self.axes, self._path.at(self._path_s)
            self.travel_rad += float(np.abs(self.axes - before).max())
            if was_moving and self._rate == 0.0:
                self.rested_s = self._time_s
        if self._path is not None and (self._path_s >= self._path.duration_s or self._cleared()):
            self.rested_s = self._time_s
            self._path, self._rate, self._clear_at_rest = None, 0.0, False
        if self._path is None and self._pending is not None and self.may_move and self._time_s >= self._pending[0]:
            (_, points), self._pending = self._pending, None
            self._start(points)

    def _cleared(self) -> bool:
        return self._clear_at_rest and self._rate == 0.0

    def _abort(self) -> None:
        """StopMove and ClearPath."""
        if self._path is not None:
            self._clear_at_rest = True

    def _start(self, points: list[TrajectoryPoint]) -> None:
        targets = [np.array(point.joints_rad[:AXES]) for point in points]
        durations = [point.duration_s for point in points]
        if not all(np.isfinite(target).all() and np.abs(target).max() <= _FURTHEST_RAD for target in targets):
            self._warn("motion error: a position is out of reach, the trajectory was aborted")
            return
        if not all(0.0 < duration_s < math.inf for duration_s in durations):
            self._warn("motion error: a duration is not positive, the trajectory was aborted")
            return
        if np.abs(targets[0] - self.axes).max() <= _NEAR_RAD:
            targets, durations = targets[1:], durations[1:]
        if not targets:
            return
        steps = np.abs(np.diff(np.vstack((self.axes, *targets)), axis=0))
        moves_s = [
            max(limit, float(least))
            for limit, least in zip(durations, (steps / _FASTEST_RAD_S).max(axis=1), strict=True)
        ]
        self._path, self._path_s, self._rate = InterpolatedPath(self.axes, targets, moves_s), 0.0, 1.0
        self.started += 1

    def _warn(self, text: str) -> None:
        _log.warning("FlexPendant: %s", text)
        self.warnings.append(text)
