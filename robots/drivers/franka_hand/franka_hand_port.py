"""The port of a Franka Hand: moves only while it is enabled."""

from __future__ import annotations

from collections.abc import Callable
from itertools import count

from robots.drivers.franka_hand.franka_hand_motion import FrankaHandMotion
from robots.drivers.franka_hand.franka_hand_reading import (
    CloseFingers,
    FrankaHandCommand,
    FrankaHandReading,
    MoveFingers,
    StopFingers,
)
from robots.drivers.fresh_link import FreshLink, FreshReading
from robots.drivers.tool_command import require_free, require_values
from robots.port import GripperSample

MAX_WIDTH_M, MAX_FORCE_N = 0.08, 70.0
MIN_SPEED_M_S, MAX_SPEED_M_S = 0.005, 0.1
PATIENCE_S = 3.0
"""Seconds by which a motion of the fingers may be late."""
# Fingers this near to one another hold nothing, whatever the hand says.
_CLOSED_M = 0.0005
_UNKNOWN = "?"
FrankaHandLink = FreshLink[FrankaHandReading, FrankaHandCommand]


class FrankaHandPort:
    """Implements `robots.port.GripperPort`.

    Closing completely is a grasp, with the force that is asked for; every other motion goes to an opening with a force
    that the hand chooses.

    Args:
        name: Name of the hand, for messages.
        link: Its connection.
        blocked: Returns why it may not move; empty if it may.
        patience_s: Seconds by which a motion of the fingers may be late.
    """

    def __init__(
        self, name: str, link: FrankaHandLink, *, blocked: Callable[[], str], patience_s: float = PATIENCE_S
    ) -> None:
        self._name = name
        self._link = link
        self._blocked = blocked
        self._patience_s = patience_s
        self._numbers = count(1)
        self._motion: FrankaHandMotion | None = None
        self._force_n = 0.0
        self._velocity_m_s = 0.0
        self._previous: FreshReading[FrankaHandReading] | None = None

    @property
    def max_width_m(self) -> float:
        """Opening when fully open, as the homing has measured it."""
        latest = self._link.latest
        stroke_m = latest.value.state.stroke_m if latest is not None else 0.0
        return stroke_m or MAX_WIDTH_M

    @property
    def max_force_n(self) -> float:
        """Maximum continuous grip force."""
        return MAX_FORCE_N

    @property
    def motion(self) -> FrankaHandMotion | None:
        """The active motion."""
        return self._motion if self._motion is not None and not self._motion.ended else None

    def next_number(self) -> int:
        """Return a number for a request."""
        return next(self._numbers)

    def sample(self) -> GripperSample:
        """Return the latest measurement.

        The hand measures no force: the commanded one is reported while it says that it grasps, else 0. It does not
        name what it touches either.

        Raises:
            RobotError: there is no fresh one.
        """
        reading, latest = self._link.fresh(), self._link.latest
        assert latest is not None
        state = reading.state
        grasps = state.is_grasping and state.width_m > _CLOSED_M
        return GripperSample(
            time_s=latest.asked_s,
            width_m=state.width_m,
            velocity_m_s=self._velocity_m_s,
            force_n=self._force_n if grasps else 0.0,
            contacts=(_UNKNOWN, _UNKNOWN) if grasps else ("", ""),
        )

    def close_to(self, *, width_m: float, speed_m_s: float, force_n: float) -> FrankaHandMotion:
        """Move the fingers towards `width_m` (open or close); closing to 0 presses with `force_n`.

        Raises:
            RobotError: it may not move, another motion is active, or a value is invalid.
        """
        positive = {"speed_m_s": speed_m_s, "force_n": force_n}
        require_values(self._name, positive=positive, zero_or_more={"width_m": width_m})
        reading = self._link.fresh()
        require_free(self._name, blocked=self._blocked(), motion=self.motion)
        start_m, goal_m = reading.state.width_m, min(width_m, self.max_width_m)
        speed = min(MAX_SPEED_M_S, max(MIN_SPEED_M_S, speed_m_s))
        force = min(MAX_FORCE_N, force_n)
        self._force_n = 0.0

        def new_command() -> MoveFingers | CloseFingers:
            if goal_m > 0.0:
                return MoveFingers(number=self.next_number(), width_m=goal_m, speed_m_s=speed)
            self._force_n = force
            return CloseFingers(number=self.next_number(), speed_m_s=speed, force_n=force)

        self._link.arm(StopFingers())
        self._motion = FrankaHandMotion(
            new_command,
            self._link.submit,
            start_m=start_m,
            goal_m=goal_m,
            limit_s=self.max_width_m / speed + self._patience_s,
        )
        return self._motion

    def take(self, reading: FreshReading[FrankaHandReading]) -> None:
        """Apply a reading."""
        previous = self._previous
        if previous is not None and reading.asked_s > previous.asked_s:
            moved_m = reading.value.state.width_m - previous.value.state.width_m
            self._velocity_m_s = moved_m / (reading.asked_s - previous.asked_s)
        self._previous = reading
        if self._motion is not None:
            self._motion.take(reading)
            if self._motion.ended:
                self._motion = None
                self._link.arm(None)

    def fail(self, reason: str, *, at_rest: bool) -> None:
        """End the active motion as failed."""
        if self._motion is not None:
            self._motion.fail(reason, at_rest=at_rest)
            self._motion = None
        self._link.arm(None)

    def note_stop(self) -> None:
        """Note that the connection itself has stopped the fingers."""

    def forget(self) -> None:
        """Forget the force of the last grasp: the hand was enabled anew."""
        self._force_n = 0.0
