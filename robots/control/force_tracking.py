"""A tool path followed while pressing as wanted: the loop of CartAdmitDMP (RCL 4.3.7)."""

from __future__ import annotations

import numpy as np

from robots.control.admittance import AdmittanceLoop
from robots.control.arm_state import ArmState
from robots.control.force_recorder import ForceRecorder
from robots.control.tool_tracker import ToolTracker
from robots.control.trajectory_playback import TrajectoryPlayback
from robots.model.robot_model import JointLimits
from robots.model.transform import RigidTransform, product, quaternion_of
from robots.port import Array, ForceTask

# The feed-forward offset of the first sample is faded in over this time.
_FADE_IN_S = 0.3
# Phase stopping answers to forces, not to the noise of their sensor.
_FORCE_SMOOTHING_S = 0.05
# Where the joints cannot follow, the passage slows down, and gives up in the end.
_SLOW_MISSING = 0.004
_MOST_MISSING = 0.02
_RAD_PER_M = 10.0
_STANDS_RAD_S = 0.002
# A tool that is pushed on and on gives way for this long once the path stands still, then rests for a moment.
_GIVING_WAY_S, _PAUSE_S = 1.2, 0.1
_AT_LIMIT_RAD = 0.01


class ForceTracking:
    """Implements `Generator`: the nominal path, plus what was learned, plus what the force leads to.

    While the path is passed the admittance of the task acts on the measured wrench less the wanted one.
    Held, cancelled, failed and at the end the path stops and the tool presses on no further: the
    offset comes to rest and only gives way to forces clearly stronger than wanted, so that a tool that
    lost its surface does not go after it, and nothing is crushed. Where they push on and on it pauses
    every other second, so that whatever pushes, a motion can end. On resuming, forces are tracked
    again at once. `data` is an encoded `ForceRecord` of the times the path was passed.

    Args:
        task: What to do, as `verified_task` takes it.
        limits: Of the joints.
        joints: Their names, for messages.
    """

    def __init__(self, task: ForceTask, *, limits: JointLimits, joints: tuple[str, ...]) -> None:
        self._task = task
        self._joints = joints
        self._limits = limits
        self._playback = TrajectoryPlayback(task.trajectory, acceleration_rad_s2=np.array(limits.acceleration_rad_s2))
        self._admittance = AdmittanceLoop(task.admittance)
        self._tracker = ToolTracker(limits=limits, start=self._playback.position)
        self._recorder = ForceRecorder(task.record_s)
        self._task_axes = RigidTransform.of((0.0, 0.0, 0.0), task.task_xyzw).rotation
        # Feed-forward offset and wanted wrench side by side, so that both are looked up at once.
        self._rows = np.hstack((task.offset, task.wrench))
        self._row = self._rows[0]
        self._passed_s = 0.0
        self._force_error_n = 0.0
        self._giving_way_s = self._pausing_s = 0.0
        self._failure = ""
        self.position = self._tracker.position
        self.velocity = self._tracker.velocity
        self.acceleration = self._tracker.acceleration

    @property
    def stopped(self) -> bool:
        """True when the path stands still, or is over, and the offset too."""
        return self._playback.stopped and float(np.abs(self.velocity).max()) < _STANDS_RAD_S

    @property
    def moving(self) -> bool:
        """True when the path is under way, or over."""
        return self._playback.moving

    @property
    def complete(self) -> bool:
        """True when the path is over and the tool at rest where the force has led it."""
        return self._playback.complete and self.stopped

    @property
    def contact(self) -> bool:
        """False: contact is its way, not its end."""
        return False

    @property
    def progress(self) -> float:
        """Share of the path's time that is passed."""
        return self._playback.progress

    @property
    def goal(self) -> Array | None:
        """None: pressing keeps a compliant arm off its set point."""
        return None

    @property
    def leads(self) -> bool:
        """True: the arm follows."""
        return True

    @property
    def failure(self) -> str:
        """That the joints cannot take the tool where the force leads it, and which one; empty while they can."""
        return self._failure

    def data(self) -> bytes:
        """Return the encoded `ForceRecord`."""
        return self._recorder.record().to_bytes()

    def step(self, step_s: float, *, target_pace: float, state: ArmState) -> None:
        """Move on by `step_s`: path, force, joints."""
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
        move = admittance.press if passing else admittance.give_way
        move(step_s, measured=measured, wanted=self._row[6:], feed_forward=self._feed_forward())
        self._follow(step_s, state)
        if passing:
            self._recorder.add(step_s, share=playback.progress, offset=admittance.total, wrench=measured)

    def _pauses(self, step_s: float) -> bool:
        """Tell whether the tool is to rest, having given way for long since the path stands still."""
        if not self._playback.stopped:
            self._giving_way_s = self._pausing_s = 0.0
            return False
        still = self.stopped
        if self._giving_way_s <= _GIVING_WAY_S:
            self._giving_way_s = 0.0 if still else self._giving_way_s + step_s
        else:
            self._pausing_s = self._pausing_s + step_s if still else 0.0
            if self._pausing_s > _PAUSE_S:
                self._giving_way_s = self._pausing_s = 0.0
        return self._giving_way_s > _GIVING_WAY_S

    def _in_task(self, wrench: Array) -> Array:
        return (wrench.reshape(2, 3) @ self._task_axes).reshape(6)

    def _feed_forward(self) -> Array:
        share = min(1.0, self._passed_s / _FADE_IN_S)
        later = 1.0 - share**3 * (10.0 - 15.0 * share + 6.0 * share * share)
        return self._row[:6] - later * self._rows[0, :6] if later > 0.0 else self._row[:6]

    def _slowdown(self, step_s: float, measured: Array, wanted: Array) -> float:
        missing = self._missing() / _SLOW_MISSING
        slowdown = 1.0 + missing * missing
        if self._task.slow_per_n > 0.0:
            error = [float(measured[axis] - wanted[axis]) for axis in self._admittance.axes if axis < 3]
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
        tracker.step(step_s, target=target, nominal=nominal, kinematics=state.kinematics, returning=self._playback.pace)
        if self._missing() > _MOST_MISSING:
            self._failure = self._reason()

    def _reason(self) -> str:
        joint = self._tracker.hindered
        angle = float(self.position[joint])
        low, high = self._limits.lower_rad[joint], self._limits.upper_rad[joint]
        at_limit = min(angle - low, high - angle) < _AT_LIMIT_RAD
        what = f"at its limit {high if high - angle < angle - low else low:.3f} rad" if at_limit else "too slow"
        missing = f"{self._tracker.missing_m * 1e3:.0f} mm and {self._tracker.missing_rad:.2f} rad are missing"
        return f"the tool cannot go where the force leads it, {missing}: {self._joints[joint]} is {what}"
