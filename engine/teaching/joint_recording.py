"""Records the joints of a robot from its topic until it is ended; the samples become a trajectory."""

from __future__ import annotations

import itertools

from engine.bus import SkillBus
from engine.errors import SkillFailed
from engine.messages import JointState
from engine.messages.demonstrations import Trajectory

SAMPLE_S = 0.01
"""Minimum time between two samples."""
MAX_SAMPLES = 30_000
_DIGITS = 6


class JointRecording:
    """Records `<robot>/joint_state` from construction until `end`; it ends automatically when it is full.

    Raises:
        BusError: the robot publishes no joints.
    """

    def __init__(self, bus: SkillBus, robot: str) -> None:
        self.robot = robot
        self._times: list[float] = []
        self._joints: list[tuple[float, ...]] = []
        self._names: tuple[str, ...] = ()
        self._start_s: float | None = None
        self.peak_rad_s = 0.0
        topic = bus.find_topic(f"{robot}/joint_state")
        self._subscription = topic.subscribe(self._take)

    @property
    def samples(self) -> int:
        """Samples so far."""
        return len(self._times)

    def end(self) -> Trajectory:
        """Stop recording and return the samples.

        Raises:
            SkillFailed: there are fewer than two samples.
        """
        self._subscription.close()
        if self.samples < 2:
            raise SkillFailed(
                "the recording is too short", where=self.robot, hint="hold the button while the arm is guided"
            )
        return Trajectory(times_s=tuple(self._times), joints=tuple(self._joints), names=self._names)

    def _take(self, message: JointState) -> None:
        if self._start_s is None:
            self._start_s, self._names = message.time_s, message.names
        time_s = round(message.time_s - self._start_s, _DIGITS)
        if self.samples >= MAX_SAMPLES or (self._times and time_s < self._times[-1] + SAMPLE_S - 1e-6):
            return
        self._times.append(time_s)
        self._joints.append(tuple(round(q, _DIGITS) for q in message.position_rad))
        self.peak_rad_s = max(self.peak_rad_s, max((abs(v) for v in message.velocity_rad_s), default=0.0))


def path_length_rad(trajectory: Trajectory) -> float:
    """Return the path length in joint space, the sum of the lengths of all steps."""
    rows = trajectory.joints
    steps = itertools.pairwise(rows)
    return sum(sum((b - a) ** 2 for a, b in zip(one, two, strict=True)) ** 0.5 for one, two in steps)
