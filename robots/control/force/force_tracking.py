"""Follows a tool path with force control: the loop of CartAdmitDMP (RCL 4.3.7)."""

from __future__ import annotations

import numpy as np

from robots.control.arm_state import ArmState
from robots.control.force.admittance import AdmittanceLoop
from robots.control.force.force_recorder import ForceRecorder
from robots.control.force.tool_tracker import ToolTracker
from robots.control.generators.trajectory_playback import TrajectoryPlayback
from robots.model.robot_model import JointLimits
from robots.model.transform import RigidTransform, product, quaternion_of
from robots.port import Array, ForceTask

# The feed-forward offset of the first sample fades in over this time.
_FADE_IN_S = 0.3
# Phase stopping reacts to forces, not to sensor noise.
_FORCE_SMOOTHING_S = 0.05
# Where the joints cannot follow, the motion slows down and finally fails.
_SLOW_MISSING = 0.004
_MOST_MISSING = 0.02
_RAD_PER_M = 10.0
_STANDS_RAD_S = 0.002
# Under a persistent push the tool yields for this long once the path stands still, then rests briefly.
_YIELDING_S, _PAUSE_S = 1.2, 0.1
_AT_LIMIT_RAD = 0.01


class ForceTracking:
    """Implements `MotionGenerator`: nominal path plus learned offset plus admittance offset.

    Along the path, the admittance of the task acts on the measured wrench minus the target one.
    When held, cancelled, failed or at its end, the path stops and the tool stops pressing: the
    offset comes to rest and yields only to forces clearly above the target ones, so that a tool that
    lost its surface does not chase it, and nothing is crushed. Under a persistent push it pauses
    every other second, so that a motion can always end. On resume, force tracking restarts
    at once. `data` is an encoded `ForceRecord` of the times of progress along the path.

    Args:
        task: The task, validated by `validate_force_task`.
        limits: Joint limits.
        joints: Joint names, for messages.
    """

    name = "force tracking"
    """For messages."""

    contact = False
    """Contact does not end this motion."""
    goal: Array | None = None
    """Pressing keeps a compliant arm off its set point."""
    leads = True
    """The arm follows."""

    def __init__(self, task: ForceTask, *, limits: JointLimits, joints: tuple[str, ...]) -> None:
        self._task = task
        self._joints = joints
        self._limits = limits
        self._playback = TrajectoryPlayback(
            task.trajectory,
            acceleration_rad_s2=np.array(limits.acceleration_rad_s2),
            jerk_rad_s3=np.array(limits.jerk_rad_s3),
        )
        self._admittance = AdmittanceLoop(task.admittance)
        self._tracker = ToolTracker(limits=limits, start=self._playback.position)
        self._recorder = ForceRecorder(task.record_s)
        self._task_axes = RigidTransform.of((0.0, 0.0, 0.0), task.task_xyzw).rotation
        # Feed-forward offset and target wrench side by side, for one lookup.
        self._rows = np.hstack((task.offset, task.wrench), dtype=np.float64)
        self._row = self._rows[0]
        self._passed_s = 0.0
        self._force_error_n = 0.0
        self._yielding_s = self._pausing_s = 0.0
        self._failure = ""
        self.position = self._tracker.position
        self.velocity = self._tracker.velocity
        self.acceleration = self._tracker.acceleration

    @property
    def stopped(self) -> bool:
        """True when path and offset stand still or have ended."""
        return self._playback.stopped and self._tracker.at_rest

    @property
    def moving(self) -> bool:
        """True while the path advances, and after its end."""
        return self._playback.moving

    @property
    def complete(self) -> bool:
        """True when the path has ended and the tool is at rest at its force-controlled offset."""
        return self._playback.complete and self.stopped

    @property
    def progress(self) -> float:
        """Elapsed share of the path's time."""
        return self._playback.progress

    @property
    def failure(self) -> str:
        """Which joint prevents the tool from following the force-controlled path; empty while it can."""
        return self._failure

    def data(self) -> bytes:
        """Return the encoded `ForceRecord`."""
        return self._recorder.record().to_bytes()

    def step(self, step_s: float, *, target_pace: float, state: ArmState) -> None:
        """Advance by `step_s`: path, force, joints."""
        measured, playback, admittance = self._in_task(state.wrench), self._playback, self._admittance
        slowdown = self._slowdown(step_s, measured, self._row[6:])
        playback.step(step_s, target_pace=target_pace / slowdown, state=state)
        self._passed_s += step_s
        index, share = playback.located()
        self._row = self._rows[index] + share * (self._rows[index + 1] - self._rows[index])
        passing = playback.moving and not playback.at_end
        if self._pauses(step_s):
            self._tracker.brake(step_s)
            return
        move = admittance.press if passing else admittance.relieve
        move(step_s, measured=measured, target=self._row[6:], feed_forward=self._feed_forward())
        self._follow(step_s, state)
        if passing:
            self._recorder.add(step_s, share=playback.progress, offset=admittance.total, wrench=measured)

    def _pauses(self, step_s: float) -> bool:
        """Return whether the tool pauses, having yielded for long since the path stands still."""
        if not self._playback.stopped:
            self._yielding_s = self._pausing_s = 0.0
            return False
        still = self.stopped
        if self._yielding_s <= _YIELDING_S:
            self._yielding_s = 0.0 if still else self._yielding_s + step_s
        else:
            self._pausing_s = self._pausing_s + step_s if still else 0.0
            if self._pausing_s > _PAUSE_S:
                self._yielding_s = self._pausing_s = 0.0
        return self._yielding_s > _YIELDING_S

    def _in_task(self, wrench: Array) -> Array:
        return (wrench.reshape(2, 3) @ self._task_axes).reshape(6)

    def _feed_forward(self) -> Array:
        share = min(1.0, self._passed_s / _FADE_IN_S)
        later = 1.0 - share**3 * (10.0 - 15.0 * share + 6.0 * share * share)
        return self._row[:6] - later * self._rows[0, :6] if later > 0.0 else self._row[:6]

    def _slowdown(self, step_s: float, measured: Array, target: Array) -> float:
        missing = self._missing() / _SLOW_MISSING
        slowdown = 1.0 + missing * missing
        if self._task.slow_per_n > 0.0:
            error = [float(measured[axis] - target[axis]) for axis in self._admittance.axes if axis < 3]
            size = sum(value * value for value in error) ** 0.5
            self._force_error_n += (size - self._force_error_n) * min(1.0, step_s / _FORCE_SMOOTHING_S)
            slowdown *= 1.0 + self._task.slow_per_n * self._force_error_n
        return slowdown

    def _missing(self) -> float:
        return self._tracker.missing_m + self._tracker.missing_rad / _RAD_PER_M

    def _follow(self, step_s: float, state: ArmState) -> None:
        tracker, nominal = self._tracker, self._playback.position
        if self._failure:
            tracker.brake(step_s)
            return
        path = state.kinematics.tool_pose(nominal)
        total = self._admittance.total.reshape(2, 3) @ self._task_axes.T
        target = RigidTransform(xyz=path.xyz + total[0], xyzw=product(quaternion_of(total[1]), path.xyzw))
        tracker.step(
            step_s,
            target=target,
            nominal=nominal,
            kinematics=state.kinematics,
            returning=self._playback.pace,
            least_rad_s=_STANDS_RAD_S if self._playback.stopped else 0.0,
        )
        if self._missing() > _MOST_MISSING:
            self._failure = self._reason()

    def _reason(self) -> str:
        joint = self._tracker.hindered
        angle = float(self.position[joint])
        low, high = self._limits.lower_rad[joint], self._limits.upper_rad[joint]
        at_limit = min(angle - low, high - angle) < _AT_LIMIT_RAD
        limit = f"position limit {high if high - angle < angle - low else low:.3f} rad" if at_limit else "speed limit"
        error = f"{self._tracker.missing_m * 1e3:.0f} mm and {self._tracker.missing_rad:.2f} rad"
        return (
            f"the tool cannot follow the force-controlled path, error {error}: {self._joints[joint]} is at its {limit}"
        )
