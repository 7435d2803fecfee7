"""The servo of a soft hand's tendon motor: closes by a share within a time and yields to a held object."""

from __future__ import annotations

from dataclasses import dataclass

from robots.control.motion_event import AnyMotionEvent
from robots.control.tool_drives.grip_task import TaskDrive

# The tendon stretches by this share of its travel under the motor's full force.
_GIVE_SHARE = 0.25
_DAMPING_S = 0.02
_REST_M_S = 0.004
_FORCE_SHARE = 0.95
# Opening fingers lag behind the releasing motor by less than this at the end.
_SLACK_SHARE = 0.02
_PATIENCE_S = 2.0


@dataclass(frozen=True, kw_only=True)
class TendonCommand:
    """The standing command of the motor: wind up to `target_m` at `speed_m_s`; `wound_m` is the present length."""

    wound_m: float
    target_m: float
    speed_m_s: float


class TendonServo(TaskDrive):
    """Pulls a tendon towards a wound-up length that changes at the commanded speed; it can only pull.

    Blocked fingers keep the tendon from following: the motor stalls at its maximum force.
    """

    def __init__(self, *, travel_m: float, max_speed_m_s: float, max_force_n: float) -> None:
        super().__init__()
        self._travel_m = travel_m
        self._max_speed_m_s = self._speed_m_s = max_speed_m_s
        self._max_force_n = max_force_n
        self._stiffness_n_m = max_force_n / (_GIVE_SHARE * travel_m)
        self._start_m = self._target_m = self._wound_m = 0.0
        self.force_n = 0.0

    @property
    def command(self) -> TendonCommand:
        """The command that stays in force if the active motion is cancelled now."""
        target = self._target_m if not self._task.number else self._wound_m
        return TendonCommand(wound_m=self._wound_m, target_m=target, speed_m_s=self._speed_m_s)

    def take_over(self, command: TendonCommand) -> None:
        """Adopt the command of another servo; drops the active motion."""
        self._task.forget()
        self._wound_m, self._target_m, self._speed_m_s = command.wound_m, command.target_m, command.speed_m_s

    @property
    def closed_share(self) -> float:
        """Wound-up share: 0 open, 1 fully closed."""
        return self._wound_m / self._travel_m

    @property
    def progress(self) -> float:
        """Completed share of the motion; 1 without a motion."""
        if not self._task.number or self._start_m == self._target_m:
            return 1.0
        return min(1.0, max(0.0, (self._wound_m - self._start_m) / (self._target_m - self._start_m)))

    def close_to(self, number: int, *, share: float, time_s: float) -> None:
        """Start winding to a share of the travel, 0 to 1, in `time_s` or as fast as the motor can."""
        self._start_m = self._wound_m
        self._target_m = min(1.0, max(0.0, share)) * self._travel_m
        distance_m = abs(self._target_m - self._start_m)
        # A motion of zero length works at any speed.
        self._speed_m_s = min(self._max_speed_m_s, distance_m / time_s) or self._max_speed_m_s
        self._task.start(number, patience_s=distance_m / self._speed_m_s + _PATIENCE_S)

    def step(self, step_s: float, *, pulled_m: float, velocity_m_s: float) -> tuple[AnyMotionEvent, ...]:
        """Set `force_n`, the pull; `pulled_m` is the tendon length released by the fingers, at `velocity_m_s`."""
        if not self._task.halted:
            stride = self._speed_m_s * step_s
            self._wound_m += min(stride, max(-stride, self._target_m - self._wound_m))
        # At maximum pull the motor does not wind further.
        self._wound_m = min(self._wound_m, max(pulled_m, 0.0) + _GIVE_SHARE * self._travel_m)
        damping = self._stiffness_n_m * _DAMPING_S
        unlimited_n = self._stiffness_n_m * (self._wound_m - pulled_m) - damping * velocity_m_s
        self.force_n = min(self._max_force_n, max(0.0, unlimited_n))
        slack = pulled_m - self._wound_m > _SLACK_SHARE * self._travel_m
        stalled = self._wound_m < self._target_m and self.force_n >= _FORCE_SHARE * self._max_force_n
        cancelled = self._task.cancelled
        events = self._task.judge(
            step_s,
            still=abs(velocity_m_s) < _REST_M_S,
            reached=(self._wound_m == self._target_m and not slack) or stalled,
            progress=lambda: self.progress,
            late=self._late,
        )
        if cancelled and not self._task.number:
            self._target_m = self._wound_m
        return events

    def _late(self, waited_s: float) -> str:
        return f"the fingers did not come to rest within {waited_s:.1f} s while closing to {self._share():.0f} %"

    def _share(self) -> float:
        return 100.0 * self._target_m / self._travel_m
