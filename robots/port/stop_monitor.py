"""The control process's side of STOP: polls its stop line once per control period, and brakes while it is latched."""

from __future__ import annotations

from engine.stop import StopLine
from robots.port.control_process import ControlledDevices


class StopMonitor:
    """Brings everything to rest on STOP without the engine, and keeps it at rest until the engine releases it.

    A motion started meanwhile fails with the reason of the stop before its first step.

    Args:
        line: The stop line; None for a process that has none.
        devices: The devices that are brought to rest.
    """

    def __init__(self, line: StopLine | None, devices: ControlledDevices) -> None:
        self._line = line
        self._devices = devices

    @property
    def cut(self) -> bool:
        """Whether the line is cut: the process ends once everything is at rest, and is reconnected with a new line."""
        return self._line is not None and self._line.cut

    def look(self) -> None:
        """Poll the line; call it after the commands of a control period and before its step."""
        if self._line is None:
            return
        reason = self._line.poll() or self._line.reason
        if reason:
            self._devices.brake(f"STOP: {reason}")
        if self._line.awaits_rest and self._devices.at_rest:
            self._line.report_at_rest()
