"""The presses of one jog, executed one after the other: what is commanded now, and since when nobody has said so."""

from __future__ import annotations

from collections import deque
from dataclasses import dataclass

from engine.skills.axes import Axes
from engine.skills.jogging import MOST_WAIT_S, JogCommand

Row = tuple[float, ...]


@dataclass(kw_only=True)
class Press:
    """A velocity that is commanded until its release; times are of the arm's clock.

    Attributes:
        velocity: In the axes `frame`; None for those of the goal.
        least_s: The arm moves for at least so long.
        heard_s: When it was commanded last.
        released_s: When it was released; None while it is held.
        moving_since_s: Since when the arm moves along it; None before.
        blocked: Whether the arm stands before an obstacle along it.
    """

    velocity: Row
    frame: Axes | None
    least_s: float
    heard_s: float
    released_s: float | None = None
    moving_since_s: float | None = None
    blocked: bool = False

    @property
    def is_unreported(self) -> bool:
        """Whether nothing else reports that it has moved nothing."""
        return self.moving_since_s is None and self.least_s > 0.0 and not self.blocked

    def is_silent(self, now_s: float, watchdog_s: float) -> bool:
        """Whether it may not begin to move: nobody says any more that it is held, nor when it was released."""
        return self.released_s is None and now_s - self.heard_s >= watchdog_s

    def over_s(self, watchdog_s: float) -> float:
        """Return when it ends if nothing else is heard.

        One that has not moved waits in silence for as long as for the check of its path: on a starved machine its
        release comes late, and must find it.
        """
        if self.released_s is None:
            return self.heard_s + watchdog_s + (MOST_WAIT_S if self.is_unreported else 0.0)
        if self.moving_since_s is not None:
            return max(self.released_s, self.moving_since_s + self.least_s)
        if self.blocked or self.least_s == 0.0:
            return self.released_s
        return self.released_s + MOST_WAIT_S


class PressQueue:
    """The press under way and those after it.

    Args:
        watchdog_s: A held press ends after so long without a command.
    """

    def __init__(self, watchdog_s: float) -> None:
        self._watchdog_s = watchdog_s
        self._presses: deque[Press] = deque()
        self.dropped = 0
        """How many have ended before the arm could move, and were not blocked."""

    @property
    def current(self) -> Press | None:
        """The press under way; None when nothing is commanded."""
        return self._presses[0] if self._presses else None

    def take(self, command: JogCommand, now_s: float) -> None:
        """Begin, continue or release a press."""
        command_s = now_s - command.age_s
        last = self._presses[-1] if self._presses else None
        is_held = last is not None and last.released_s is None
        if last is not None and is_held and (command.least_s > 0.0 or not any(command.velocity)):
            last.released_s, is_held = command_s, False
        if not any(command.velocity):
            return
        if last is not None and is_held:
            last.velocity, last.frame, last.heard_s, last.blocked = command.velocity, command.frame, command_s, False
            return
        self._presses.append(
            Press(velocity=command.velocity, frame=command.frame, least_s=command.least_s, heard_s=command_s)
        )

    def advance(self, now_s: float) -> Press | None:
        """Leave the presses that are over, and return the one under way."""
        while self._presses and now_s >= self._presses[0].over_s(self._watchdog_s):
            self.dropped += self._presses.popleft().is_unreported
        return self.current

    def due_s(self) -> float | None:
        """Return when the press under way is over if nothing else is heard; None without one."""
        return self._presses[0].over_s(self._watchdog_s) if self._presses else None
