"""The switch of a magnet: ramps its field up or down and keeps it."""

from __future__ import annotations

from dataclasses import dataclass

from robots.control.motion_event import AnyMotionEvent
from robots.control.tool_drives.grip_task import TaskDrive

_PATIENCE_S = 2.0


@dataclass(frozen=True, kw_only=True)
class MagnetCommand:
    """Commanded switch state, and the present share of the field, 0 to 1."""

    on: bool
    level: float


class MagnetDrive(TaskDrive):
    """Moves the field's level to 1 or 0 in `switch_s`.

    A switch is an output: once set it takes effect. Holding or cancelling its motion changes only when
    the end is reported; it never releases a part half-way.
    """

    def __init__(self, *, switch_s: float) -> None:
        super().__init__()
        self._switch_s = switch_s
        self.on = False
        self.level = 0.0

    @property
    def command(self) -> MagnetCommand:
        """The present command."""
        return MagnetCommand(on=self.on, level=self.level)

    def take_over(self, command: MagnetCommand) -> None:
        """Adopt the command of another drive; drops the active motion."""
        self._task.forget()
        self.on, self.level = command.on, command.level

    @property
    def progress(self) -> float:
        """Completed share of the switch; 1 without a motion."""
        if not self._task.number:
            return 1.0
        return self.level if self.on else 1.0 - self.level

    def switch(self, number: int, *, on: bool) -> None:
        """Start switching."""
        self.on = on
        self._task.start(number, patience_s=self._switch_s + _PATIENCE_S)

    def step(self, step_s: float, *, still: bool) -> tuple[AnyMotionEvent, ...]:
        """Advance `level` and return the events; `still` if no attracted object moves."""
        target = 1.0 if self.on else 0.0
        stride = step_s / self._switch_s
        self.level += min(stride, max(-stride, target - self.level))
        settled = self.level == target
        return self._task.judge(
            step_s, still=settled and still, reached=settled, progress=lambda: self.progress, late=_late
        )


def _late(waited_s: float) -> str:
    return f"the attracted object did not come to rest within {waited_s:.1f} s"
