"""The control process's side of STOP: looks at its stop line once a control period, and brakes while it is latched."""

from __future__ import annotations

from engine.stop import StopLine
from robots.port.control_process import ControlledDevices


class StopMonitor:
    """Brings everything to rest on STOP without asking the engine, and keeps it there until the engine releases.

    A motion that is started meanwhile fails with the reason of the stop before its first step.

    Args:
        line: The stop line; None for a process that has none.
        devices: What is brought to rest.
    """

    def __init__(self, line: StopLine | None, devices: ControlledDevices) -> None:
        self._line = line
        self._devices = devices

    @property
    def cut(self) -> bool:
        """Whether the line is cut: the process ends once everything rests, and is connected again with a new one."""
        return self._line is not None and self._line.cut

    def look(self) -> None:
        """Take what has arrived; call it after the commands of a control period and before its step."""
        if self._line is None:
            return
        reason = self._line.poll() or self._line.reason
        if reason:
            self._devices.brake(f"STOP: {reason}")
        if self._line.awaits_rest and self._devices.at_rest:
            self._line.report_at_rest()
