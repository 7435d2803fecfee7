"""Shared context of all faults of one run: clock, event log, process kill, and end of the run."""

from __future__ import annotations

from collections.abc import Callable

from engine.clock import Clock
from engine.event import FaultInjected
from engine.faults.fault_rule import FaultRule
from engine.runtime.record.recorder import Recorder


class FaultContext:
    """Context of the faults of one run; used on the loop thread."""

    def __init__(self, clock: Clock, kill: Callable[[], None]) -> None:
        self.clock = clock
        self.kill = kill
        self.over = False
        """True when all states have ended, except abandoned ones."""
        self.recorder: Recorder | None = None

    def apply(self, rule: FaultRule, path: str, address: str, detail: str) -> None:
        """Count and record that a fault is applied to a request of the state at `path`."""
        rule.applied += 1
        self.note(rule, path, address, detail)

    def note(self, rule: FaultRule, path: str, address: str, detail: str) -> None:
        """Record a further effect of an applied fault."""
        recorder = self.recorder
        if recorder is not None:
            recorder.emit(FaultInjected, path=path, address=address, fault=rule.label, detail=detail)

    def warn(self, message: str) -> None:
        """Write a warning about the run as a whole into its event log."""
        recorder = self.recorder
        if recorder is not None:
            recorder.log("root", message, level="warning")
