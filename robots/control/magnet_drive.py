"""The switch of a magnet: its field comes up or goes down within a short time and stays so."""

from __future__ import annotations

from dataclasses import dataclass

from robots.control.grip_task import GripTask
from robots.control.motion_event import AnyMotionEvent

_PATIENCE_S = 2.0


@dataclass(frozen=True, kw_only=True)
class MagnetCommand:
    """Whether the magnet is to hold, and the share of its field that is up, 0 to 1."""

    on: bool
    level: float


class MagnetDrive:
    """Moves the field's level to 1 or 0 in `switch_s`.

    A switch is an output: once set it takes effect. Holding or cancelling its motion changes when
    the end is told, and never lets go of a part half-way.
    """

    def __init__(self, *, switch_s: float) -> None:
        self._switch_s = switch_s
        self._task = GripTask()
        self.on = False
        self.level = 0.0

    @property
    def command(self) -> MagnetCommand:
        """What goes on."""
        return MagnetCommand(on=self.on, level=self.level)

    def take_over(self, command: MagnetCommand) -> None:
        """Do from now on what another switch did; whatever ran is forgotten."""
        self._task.forget()
        self.on, self.level = command.on, command.level

    @property
    def number(self) -> int:
        """The motion under way, 0 when there is none."""
        return self._task.number

    @property
    def progress(self) -> float:
        """How far the field has come to what is wanted; 1 when there is no motion."""
        if not self._task.number:
            return 1.0
        return self.level if self.on else 1.0 - self.level

    def switch(self, number: int, *, on: bool) -> None:
        """Start switching."""
        self.on = on
        self._task.start(number, patience_s=self._switch_s + _PATIENCE_S)

    def hold(self, number: int, *, request: int = 0) -> None:
        """Tell nothing more until resumed."""
        self._task.hold(number, request=request)

    def resume(self, number: int, *, request: int = 0) -> None:
        """Tell the end again."""
        self._task.resume(number, request=request)

    def cancel(self, number: int) -> None:
        """End as canceled once the field stands still."""
        self._task.cancel(number)

    def stop(self, cause: str = "") -> None:
        """Cancel whatever runs, what is held stays held; with a `cause` it ends as failed."""
        self._task.stop(cause)

    def step(self, step_s: float, *, still: bool) -> tuple[AnyMotionEvent, ...]:
        """Move `level` on and return what happened; `still` when nothing moves that the magnet pulls."""
        target = 1.0 if self.on else 0.0
        stride = step_s / self._switch_s
        self.level += min(stride, max(-stride, target - self.level))
        settled = self.level == target
        return self._task.judge(
            step_s, still=settled and still, reached=settled, progress=lambda: self.progress, late=_late
        )


def _late(waited_s: float) -> str:
    return f"what the magnet pulls does not come to rest within {waited_s:.1f} s"
