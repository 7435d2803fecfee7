"""Two fingers moved alike by a force-limited position servo: open, close, press and keep pressing."""

from __future__ import annotations

from dataclasses import dataclass

from robots.control.motion_event import AnyMotionEvent, MotionFinished, MotionHeld, MotionResumed
from robots.model.robot_model import GripperModel
from robots.port import MotionEnd

# For fingers with 0.2 kg behind them: 20 N at 1 mm, well damped.
_STIFFNESS_N_M = 20_000.0
_DAMPING_NS_M = 90.0
_REST_M_S = 0.002
_REST_S = 0.06
_AT_WIDTH_M = 0.001
_FORCE_SHARE = 0.95
_PATIENCE_S = 2.0


@dataclass(frozen=True, kw_only=True)
class FingerCommand:
    """What the fingers do without a motion: go to `target_m` and press with at most `force_n`.

    `set_m` is how far the set point has come; against an object it stays ahead of the opening by
    what the force needs.
    """

    set_m: float
    target_m: float
    speed_m_s: float
    force_n: float


@dataclass(kw_only=True)
class _Closing:
    """The motion under way."""

    number: int
    target_m: float
    start_m: float
    deadline_s: float
    hold: bool = False
    request: int = 0
    told_held: bool = False
    tell_resumed: bool = False
    cancel: bool = False
    waited_s: float = 0.0


class FingerServo:
    """Force per finger towards a set point of the opening that moves at the wanted speed.

    Widths are openings between the pads in metres; a finger moves half of it. Positive force opens.
    """

    def __init__(self, gripper: GripperModel) -> None:
        self._gripper = gripper
        self._closing: _Closing | None = None
        self._set_m = self._target_m = gripper.max_width_m
        self._speed_m_s = gripper.max_speed_m_s
        self._limit_n = gripper.max_force_n
        self._rest_s = 0.0
        self.force_n = 0.0

    def initialize(self, width_m: float) -> None:
        """Keep the opening `width_m` from now on."""
        self._set_m = self._target_m = width_m
        self._limit_n = self._gripper.max_force_n

    @property
    def command(self) -> FingerCommand:
        """What would go on if the motion under way, if any, were cancelled now."""
        target = self._target_m if self._closing is None else self._set_m
        return FingerCommand(set_m=self._set_m, target_m=target, speed_m_s=self._speed_m_s, force_n=self._limit_n)

    def take_over(self, command: FingerCommand) -> None:
        """Do from now on what another servo did; whatever ran is forgotten."""
        self._closing, self._rest_s = None, 0.0
        self._set_m, self._target_m = command.set_m, command.target_m
        self._speed_m_s, self._limit_n = command.speed_m_s, command.force_n

    @property
    def number(self) -> int:
        """The motion under way, 0 when there is none."""
        return self._closing.number if self._closing else 0

    @property
    def commanded_force_n(self) -> float:
        """The greatest force that the present command allows."""
        return self._limit_n

    def progress(self, width_m: float) -> float:
        """Share of the way to the commanded opening that is passed; 1 when there is no motion."""
        closing = self._closing
        if closing is None or closing.start_m == closing.target_m:
            return 1.0
        share = (closing.start_m - width_m) / (closing.start_m - closing.target_m)
        return min(1.0, max(0.0, share))

    def close_to(self, number: int, *, width_m: float, speed_m_s: float, force_n: float, now_m: float) -> None:
        """Start towards an opening; what is out of the gripper's range is brought into it."""
        gripper = self._gripper
        target = min(max(width_m, 0.0), gripper.max_width_m)
        speed = min(speed_m_s, gripper.max_speed_m_s)
        self._limit_n = min(force_n, gripper.max_force_n)
        # A part that is held stays under force while a new command takes over.
        self._set_m = min(self._set_m, now_m) if target < now_m else max(self._set_m, now_m)
        self._target_m, self._speed_m_s = target, speed
        self._rest_s = 0.0
        patience = abs(target - now_m) / speed + _PATIENCE_S
        self._closing = _Closing(number=number, target_m=target, start_m=now_m, deadline_s=patience)

    def hold(self, number: int, *, request: int = 0) -> None:
        """Stop the fingers on their way."""
        closing = self._closing
        if closing and closing.number == number:
            closing.hold, closing.told_held, closing.tell_resumed = True, False, False
            closing.request = request

    def resume(self, number: int, *, request: int = 0) -> None:
        """Let the fingers go on."""
        closing = self._closing
        if closing and closing.number == number:
            closing.hold, closing.tell_resumed, closing.request = False, True, request

    def cancel(self, number: int) -> None:
        """Stop the fingers where they are and end as canceled."""
        if self._closing and self._closing.number == number:
            self._closing.cancel = True

    def stop(self) -> None:
        """Cancel whatever runs; a force that holds a part is kept."""
        self.cancel(self.number)

    def step(self, step_s: float, *, width_m: float, velocity_m_s: float) -> tuple[AnyMotionEvent, ...]:
        """Set `force_n` for each finger and return what happened; both measures are of the opening."""
        closing = self._closing
        if closing is None or not (closing.hold or closing.cancel):
            # Also after the end: what is held may give, and the force follows it.
            self._advance(step_s, width_m)
        wanted = _STIFFNESS_N_M * (self._set_m - width_m) / 2.0 - _DAMPING_NS_M * velocity_m_s / 2.0
        self.force_n = min(self._limit_n, max(-self._limit_n, wanted))
        self._rest_s = self._rest_s + step_s if abs(velocity_m_s) < _REST_M_S else 0.0
        return () if closing is None else self._judge(closing, step_s, width_m)

    def _advance(self, step_s: float, width_m: float) -> None:
        stride = self._speed_m_s * step_s
        gap = self._target_m - self._set_m
        self._set_m += min(stride, max(-stride, gap))
        # Blocked fingers: the set point runs ahead only as far as full force needs.
        lead = 2.2 * self._limit_n / _STIFFNESS_N_M
        self._set_m = min(width_m + lead, max(width_m - lead, self._set_m))

    def _judge(self, closing: _Closing, step_s: float, width_m: float) -> tuple[AnyMotionEvent, ...]:
        at_rest = self._rest_s >= _REST_S
        if closing.tell_resumed:
            closing.tell_resumed = False
            self._rest_s = 0.0
            return (MotionResumed(motion=closing.number, request=closing.request),)
        if closing.cancel:
            if at_rest:
                self._target_m = self._set_m
                return self._finish(closing, MotionEnd.CANCELED, width_m)
            return self._out_of_time(closing, step_s, width_m)
        if closing.hold:
            if not at_rest or closing.told_held:
                return ()
            closing.told_held = True
            return (MotionHeld(motion=closing.number, request=closing.request),)
        arrived = self._set_m == closing.target_m and abs(width_m - closing.target_m) < _AT_WIDTH_M
        pressing = abs(self.force_n) >= _FORCE_SHARE * self._limit_n
        if at_rest and (arrived or pressing):
            return self._finish(closing, MotionEnd.REACHED, width_m)
        return self._out_of_time(closing, step_s, width_m)

    def _out_of_time(self, closing: _Closing, step_s: float, width_m: float) -> tuple[AnyMotionEvent, ...]:
        closing.waited_s += step_s
        if closing.waited_s < closing.deadline_s:
            return ()
        reason = (
            f"the fingers are neither at {closing.target_m * 1e3:.1f} mm "
            f"nor at rest against something after {closing.waited_s:.1f} s"
        )
        return self._finish(closing, MotionEnd.FAILED, width_m, reason)

    def _finish(
        self, closing: _Closing, end: MotionEnd, width_m: float, reason: str = ""
    ) -> tuple[AnyMotionEvent, ...]:
        progress = self.progress(width_m)
        self._closing = None
        return (MotionFinished(motion=closing.number, end=end.value, progress=progress, reason=reason),)
