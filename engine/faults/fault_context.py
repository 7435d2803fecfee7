"""What all faults of one run share: its clock and event log, what kills the process, and when it is over."""

from __future__ import annotations

from collections.abc import Callable

from engine.clock import Clock
from engine.event import FaultInjected
from engine.faults.fault_rule import FaultRule
from engine.runtime.record.recorder import Recorder


class FaultContext:
    """Where faults happen; belongs to one run, used on the loop thread."""

    def __init__(self, clock: Clock, kill: Callable[[], None]) -> None:
        self.clock = clock
        self.kill = kill
        self.over = False
        """True when all states are left, but for those that the run has given up."""
        self.recorder: Recorder | None = None

    def apply(self, rule: FaultRule, path: str, address: str, detail: str) -> None:
        """Count and record that a fault is applied to a request of the state at `path`."""
        rule.applied += 1
        self.note(rule, path, address, detail)

    def note(self, rule: FaultRule, path: str, address: str, detail: str) -> None:
        """Record what else a fault that is applied brings about."""
        recorder = self.recorder
        if recorder is not None:
            recorder.emit(FaultInjected, path=path, address=address, fault=rule.label, detail=detail)

    def warn(self, message: str) -> None:
        """Write a warning about the run as a whole into its event log."""
        recorder = self.recorder
        if recorder is not None:
            recorder.log("root", message, level="warning")
