"""The port of a real SoftHand: closed share and pull outside, ticks and milliampere inside; moves while enabled."""

from __future__ import annotations

import asyncio
import logging
import time
from bisect import bisect_right
from collections import deque
from collections.abc import Callable, Sequence
from dataclasses import dataclass

from robots.drivers.fresh_link import FreshLink, FreshReading
from robots.drivers.softhand.hand_reading import HandCommand, HandReading, HandReference
from robots.drivers.softhand.softhand_motion import HandGoal, SoftHandMotion
from robots.drivers.tool_command import require_free, require_values
from robots.port import HandSample

_UNKNOWN = "?"
_FINGERS_AND_PALM = 6
# As `check_hand_grasp` has it: less is hardly more than closing on nothing.
_PRESSES_SHARE = 0.03
_SETTLED_S = 0.5
_log = logging.getLogger("flexcell.devices")

HandLink = FreshLink[HandReading, HandCommand]


@dataclass(frozen=True, kw_only=True)
class HandCalibration:
    """What converts between the hand's units and ours.

    Attributes:
        closed_ticks: Position of the closed hand; 0 is open.
        stroke_s: Shortest time from open to closed.
        free_ma: Closed share and motor current for closing on nothing, from open to closed.
        current_limit_ma: Motor current at which closing ends.
        fault_ma: Motor current that is a fault.
        force_n_ma: Pull of the motor for each milliampere.
    """

    closed_ticks: int
    stroke_s: float
    free_ma: Sequence[tuple[float, float]]
    current_limit_ma: float
    fault_ma: float
    force_n_ma: float

    def share(self, reading: HandReading) -> float:
        """Return the closed share, 0 to 1."""
        return min(1.0, max(0.0, reading.position_ticks / self.closed_ticks))

    def pull_n(self, reading: HandReading) -> float:
        """Return the pull beyond that for closing equally far on nothing."""
        return max(0.0, reading.current_ma - self._free_ma(self.share(reading))) * self.force_n_ma

    def presses(self, reading: HandReading) -> bool:
        """Return whether that is more than the noise of closing on nothing."""
        return self.pull_n(reading) >= _PRESSES_SHARE * self.current_limit_ma * self.force_n_ma

    def _free_ma(self, share: float) -> float:
        shares = [entry[0] for entry in self.free_ma]
        upper = min(max(1, bisect_right(shares, share)), len(self.free_ma) - 1)
        (low, low_ma), (high, high_ma) = self.free_ma[upper - 1], self.free_ma[upper]
        return low_ma + min(1.0, max(0.0, (share - low) / (high - low))) * (high_ma - low_ma)


class SoftHandPort:
    """Implements `robots.port.HandPort`.

    Args:
        name: Name of the hand, for messages.
        link: Its connection.
        calibration: Its units.
        blocked: Returns why it may not move; empty if it may.
    """

    def __init__(self, name: str, link: HandLink, *, calibration: HandCalibration, blocked: Callable[[], str]) -> None:
        self._name = name
        self._link = link
        self._calibration = calibration
        self._blocked = blocked
        self._motion: SoftHandMotion | None = None
        self._commanded: deque[int] = deque(maxlen=4)
        self._commanded_s = 0.0

    @property
    def max_force_n(self) -> float:
        """Pull of the motor at the current limit."""
        return self._calibration.current_limit_ma * self._calibration.force_n_ma

    @property
    def motion(self) -> SoftHandMotion | None:
        """The active motion."""
        return self._motion if self._motion is not None and not self._motion.ended else None

    def sample(self) -> HandSample:
        """Return the latest measurement.

        The hand feels no contacts: while its motor pulls more than for closing on nothing, each finger and the palm
        touch something unknown, else nothing.

        Raises:
            RobotError: there is no fresh one.
        """
        reading, latest = self._link.fresh(), self._link.latest
        assert latest is not None
        touching = _UNKNOWN if self._calibration.presses(reading) else ""
        return HandSample(
            time_s=latest.asked_s,
            closed_share=self._calibration.share(reading),
            force_n=self._calibration.pull_n(reading),
            contacts=(touching,) * _FINGERS_AND_PALM,
        )

    def close_to(self, *, share: float, time_s: float) -> SoftHandMotion:
        """Close or open to `share`, 0 to 1, in `time_s` or as fast as the motor can.

        Raises:
            RobotError: it may not move, another motion is active, or a value is invalid.
        """
        require_values(self._name, positive={"time_s": time_s}, zero_or_more={"share": share})
        self._link.fresh()
        require_free(self._name, blocked=self._blocked(), motion=self.motion)
        latest, calibration = self._link.latest, self._calibration
        assert latest is not None
        ticks = round(min(1.0, share) * calibration.closed_ticks)
        fastest = calibration.closed_ticks / calibration.stroke_s
        # A motion of zero length works at any speed.
        reference = self._commanded[-1] if self._commanded else latest.value.reference_ticks
        speed = min(fastest, abs(ticks - reference) / time_s) or fastest
        goal = HandGoal(ticks=ticks, speed_ticks_s=speed, current_limit_ma=calibration.current_limit_ma)
        self._motion = SoftHandMotion(
            goal, self._submit, presses=calibration.presses, start=latest, reference_ticks=reference
        )
        self._arm()
        return self._motion

    def take(self, reading: FreshReading[HandReading]) -> None:
        """Apply a reading."""
        if self._motion is None:
            return
        self._motion.take(reading)
        if self._motion.ended:
            self._motion = None
        self._arm()

    def fail(self, reason: str, *, at_rest: bool) -> None:
        """End the active motion as failed; its reference goes no further."""
        if self._motion is not None:
            self._motion.fail(reason, at_rest=at_rest)
            self._motion = None
        self._arm()

    def withdraw(self, reading: HandReading) -> None:
        """Follow the present position, so that the motor does not go on pulling."""
        if self._commanded and self._commanded[-1] != reading.position_ticks:
            self._submit(HandReference(ticks=reading.position_ticks)).add_done_callback(_note_failure)

    def note_stop(self) -> None:
        """Note that the connection itself has stopped the hand."""

    def forget(self) -> None:
        """Forget the last reference: the hand was enabled anew."""
        self._commanded.clear()

    def foreign_ticks(self, reading: FreshReading[HandReading]) -> int | None:
        """Return the reference that the hand follows and that is none of our last ones; None if it is ours."""
        now = reading.value
        if not self._commanded:
            return None
        if reading.asked_s - self._commanded_s > _SETTLED_S and now.reference_ticks != self._commanded[-1]:
            return now.reference_ticks
        references = (now.before_ticks, now.reference_ticks)
        return next((ticks for ticks in references if ticks not in self._commanded), None)

    def _submit(self, reference: HandReference) -> asyncio.Future[float]:
        latest = self._link.latest
        if not self._commanded and latest is not None:
            self._commanded.append(latest.value.reference_ticks)
        self._commanded.append(reference.ticks)
        self._commanded_s = time.monotonic()
        return self._link.submit(reference)

    def _arm(self) -> None:
        """Let the connection hold the present reference should the engine become silent."""
        moving = self.motion
        self._link.arm(HandReference(ticks=round(moving.reference_ticks)) if moving is not None else None)


def _note_failure(written: asyncio.Future[float]) -> None:
    error = written.exception()
    if error is not None:
        _log.error("the reference of a hand with a fault could not be withdrawn: %s", error)
