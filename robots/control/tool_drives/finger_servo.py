"""A force-limited position servo for two symmetric fingers: open, close, press and keep pressing."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

from robots.control.motion_event import AnyMotionEvent
from robots.control.tool_drives.grip_task import TaskDrive

# For fingers with 0.2 kg behind them that is 20 N at 1 mm, well damped.
_STIFFNESS_PER_S2 = 100_000.0
_DAMPING_PER_S = 450.0
_REST_M_S = 0.002
_AT_WIDTH_M = 0.001
_FORCE_SHARE = 0.95
_PATIENCE_S = 2.0


class GripperLimits(Protocol):
    """The gripper limits that the servo needs."""

    @property
    def max_width_m(self) -> float:
        """Opening when fully open."""
        ...

    @property
    def max_speed_m_s(self) -> float:
        """Maximum speed of the opening."""
        ...

    @property
    def max_force_n(self) -> float:
        """Maximum force of a finger."""
        ...


@dataclass(frozen=True, kw_only=True)
class FingerCommand:
    """The standing command of the fingers: move to `target_m` and press with at most `force_n`.

    `set_m` is the present set point; against an object it leads the opening by what the force requires.
    """

    set_m: float
    target_m: float
    speed_m_s: float
    force_n: float


class FingerServo(TaskDrive):
    """Computes the force per finger towards a set point of the opening that moves at the commanded speed.

    Widths are openings between the pads in metres; each finger moves half of it. Positive force opens.

    Args:
        opening: The gripper's range.
        min_force_n: Minimum force; smaller commands are raised to it.
        finger_kg: Effective mass of each finger, including motor inertia.
    """

    def __init__(self, opening: GripperLimits, *, min_force_n: float = 0.0, finger_kg: float = 0.2) -> None:
        super().__init__()
        self._opening = opening
        self._min_force_n = min_force_n
        self._stiffness_n_m = _STIFFNESS_PER_S2 * finger_kg
        self._damping_ns_m = _DAMPING_PER_S * finger_kg
        self._start_m = 0.0
        self._set_m = self._target_m = opening.max_width_m
        self._speed_m_s = opening.max_speed_m_s
        self._limit_n = opening.max_force_n
        self.force_n = 0.0

    def initialize(self, width_m: float) -> None:
        """Hold the opening `width_m`."""
        self._set_m = self._target_m = width_m
        self._limit_n = self._opening.max_force_n

    @property
    def command(self) -> FingerCommand:
        """The command that stays in force if the active motion is cancelled now."""
        target = self._target_m if not self._task.number else self._set_m
        return FingerCommand(set_m=self._set_m, target_m=target, speed_m_s=self._speed_m_s, force_n=self._limit_n)

    def take_over(self, command: FingerCommand) -> None:
        """Adopt the command of another servo; drops the active motion."""
        self._task.forget()
        self._set_m, self._target_m = command.set_m, command.target_m
        self._speed_m_s, self._limit_n = command.speed_m_s, command.force_n

    def progress(self, width_m: float) -> float:
        """Completed share of the path to the commanded opening; 1 without a motion."""
        if not self._task.number or self._start_m == self._target_m:
            return 1.0
        share = (self._start_m - width_m) / (self._start_m - self._target_m)
        return min(1.0, max(0.0, share))

    def close_to(self, number: int, *, width_m: float, speed_m_s: float, force_n: float, now_m: float) -> None:
        """Start towards an opening; values are clipped to the gripper's range."""
        opening = self._opening
        target = min(max(width_m, 0.0), opening.max_width_m)
        speed = min(speed_m_s, opening.max_speed_m_s)
        self._limit_n = min(max(force_n, self._min_force_n), opening.max_force_n)
        # A held part stays under force while a new command takes over.
        self._set_m = min(self._set_m, now_m) if target < now_m else max(self._set_m, now_m)
        self._target_m, self._speed_m_s, self._start_m = target, speed, now_m
        self._task.start(number, patience_s=abs(target - now_m) / speed + _PATIENCE_S)

    def step(self, step_s: float, *, width_m: float, velocity_m_s: float) -> tuple[AnyMotionEvent, ...]:
        """Set `force_n` for each finger and return the events; both measurements refer to the opening."""
        if not self._task.halted:
            # Also after the end: a held object may yield, and the force follows it.
            self._advance(step_s, width_m)
        unlimited_n = self._stiffness_n_m * (self._set_m - width_m) / 2.0 - self._damping_ns_m * velocity_m_s / 2.0
        self.force_n = min(self._limit_n, max(-self._limit_n, unlimited_n))
        arrived = self._set_m == self._target_m and abs(width_m - self._target_m) < _AT_WIDTH_M
        pressing = abs(self.force_n) >= _FORCE_SHARE * self._limit_n
        cancelled = self._task.cancelled
        events = self._task.judge(
            step_s,
            still=abs(velocity_m_s) < _REST_M_S,
            reached=arrived or pressing,
            progress=lambda: self.progress(width_m),
            late=self._late,
        )
        if cancelled and not self._task.number:
            self._target_m = self._set_m
        return events

    def _advance(self, step_s: float, width_m: float) -> None:
        stride = self._speed_m_s * step_s
        gap = self._target_m - self._set_m
        self._set_m += min(stride, max(-stride, gap))
        # Blocked fingers: the set point leads only as far as full force requires.
        lead = 2.2 * self._limit_n / self._stiffness_n_m
        self._set_m = min(width_m + lead, max(width_m - lead, self._set_m))

    def _late(self, waited_s: float) -> str:
        return (
            f"the fingers neither reached {self._target_m * 1e3:.1f} mm "
            f"nor stopped against an object within {waited_s:.1f} s"
        )
