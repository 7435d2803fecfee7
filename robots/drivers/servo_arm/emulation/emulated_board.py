"""The emulated board: what the sketch flexcell_servo_arm does with a line, and with time."""

from __future__ import annotations

from collections.abc import Callable, Sequence

LOWER_DEG, UPPER_DEG = 0.0, 180.0
CLAW_OPEN_DEG, CLAW_CLOSED_DEG = 90.0, 45.0
_LONGEST_LINE = 63


class EmulatedBoard:
    """Angles with time behind them; `now_s` is its clock.

    Attributes:
        written_deg: Angles that are written to the servos, the claw's last.
        halt: Why it takes no set points: `boot`, `stop`, `watchdog`; empty if it does.
        attached: Whether the servos get pulses: not after a start, before the first GO or angles.
        defect: What it answers each line with as an error; empty without one.
        travel: Degrees that all servos have passed.
        commands: Number of set points executed.
        moved_s: When a servo last turned.
    """

    def __init__(
        self, now_s: Callable[[], float], *, home_deg: Sequence[float], max_deg_s: float, watchdog_s: float
    ) -> None:
        self.now_s = now_s
        self._home_deg = (*home_deg, CLAW_OPEN_DEG)
        self._max_deg_s = max_deg_s
        self._watchdog_s = watchdog_s
        self.written_deg = list(self._home_deg)
        self._target_deg = list(self._home_deg)
        self.halt = "boot"
        self.attached = False
        self.defect = ""
        self._closes = False
        self.travel = 0.0
        self.commands = 0
        self.moved_s = self._time_s = self._line_s = self._set_point_s = now_s()

    @property
    def servos(self) -> int:
        """Number of joints."""
        return len(self._home_deg) - 1

    @property
    def closes(self) -> bool:
        """Whether the claw was told to close last."""
        return self._closes

    @property
    def moving(self) -> bool:
        """Whether a servo turns."""
        self.advance()
        return self.written_deg != self._target_deg

    def restart(self) -> None:
        """Start anew: nothing moves before GO, and the angles are assumed to be those of home."""
        self.advance()
        self.halt, self.attached, self.defect, self._closes = "boot", False, "", False
        self.written_deg, self._target_deg = list(self._home_deg), list(self._home_deg)

    def execute(self, line: bytes) -> bytes:
        """Execute a line without its end, and return the answer."""
        self.advance()
        self._line_s = self.now_s()
        if self.defect:
            return f"ERR {self.defect}\n".encode()
        match line:
            case _ if len(line) > _LONGEST_LINE:
                return b"ERR not understood\n"
            case b"?":
                pass
            case b"GO":
                self._target_deg, self.halt, self.attached = list(self.written_deg), "", True
                self._set_point_s = self._line_s
            case b"STOP":
                self._target_deg, self.halt = list(self.written_deg), self.halt or "stop"
            case b"pick" | b"place":
                if not self.halt:
                    self._closes = line == b"pick"
                    self._target_deg[-1] = CLAW_CLOSED_DEG if self._closes else CLAW_OPEN_DEG
            case _:
                refusal = self._set_point(line)
                if refusal:
                    return f"ERR {refusal}\n".encode()
        return self._state()

    def follow(self, angles_deg: Sequence[float]) -> None:
        """Turn the servos to angles, without any condition, as a sketch without answers does."""
        self.advance()
        self.commands += 1
        self.attached = True
        self._set_point_s = self.now_s()
        self._target_deg[: self.servos] = angles_deg

    def advance(self) -> None:
        """Turn the servos up to now, or up to when the watchdog held them."""
        now_s, watched = self.now_s(), self._watchdog_s > 0.0 and not self.halt
        if watched and now_s - self._set_point_s > self._watchdog_s:
            self._turn_until(self._set_point_s + self._watchdog_s)
            if self.written_deg[: self.servos] != self._target_deg[: self.servos]:
                self._hold(now_s)
                return
        if watched and now_s - self._line_s > self._watchdog_s:
            self._turn_until(self._line_s + self._watchdog_s)
            self._hold(now_s)
            return
        self._turn_until(now_s)

    def _hold(self, now_s: float) -> None:
        self._target_deg, self.halt, self._time_s = list(self.written_deg), "watchdog", now_s

    def _turn_until(self, until_s: float) -> None:
        if until_s > self._time_s:
            elapsed_s, self._time_s = until_s - self._time_s, until_s
            self._turn(elapsed_s)

    def _turn(self, elapsed_s: float) -> None:
        for index, target in enumerate(self._target_deg):
            distance = target - self.written_deg[index]
            turned = min(abs(distance), self._max_deg_s * elapsed_s)
            if turned:
                self.travel += turned
                self.moved_s = self.now_s()
                at_target = turned == abs(distance)
                self.written_deg[index] = (
                    target if at_target else self.written_deg[index] + (turned if distance > 0 else -turned)
                )

    def _set_point(self, line: bytes) -> str:
        angles = angles_of(line)
        if len(angles) != self.servos:
            return "not understood"
        if not all(LOWER_DEG <= angle <= UPPER_DEG for angle in angles):
            return "out of range"
        if not self.halt:
            self.follow(angles)
        return ""

    def _state(self) -> bytes:
        words = [f"HALT {self.halt}" if self.halt else "OK"]
        words += [f"{angle:.1f}" for angle in self.written_deg[: self.servos]]
        words += ["pick" if self._closes else "place"]
        return (" ".join(words) + "\n").encode()


def angles_of(line: bytes) -> tuple[float, ...]:
    """Return the angles in a line; empty if it is none."""
    try:
        return tuple(float(word) for word in line.decode("ascii").split())
    except ValueError:
        return ()
