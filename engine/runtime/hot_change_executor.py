"""Replaces the behavior that a run executes with a new version, after all checks have passed."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from engine.errors import ControlError
from engine.runtime.control import Control
from engine.runtime.history.hot_change import ChangeReport, VersionSnapshot, definitions, plan_change
from engine.runtime.nodes.execution import Execution
from engine.runtime.nodes.node import Node
from engine.runtime.plan import Plan
from engine.runtime.run_log import RunLog

_PREEMPT_HINT = "the run continues with the old version; `preempt` preempts what cannot continue in the new one"


@dataclass(frozen=True, kw_only=True)
class HotChangeExecutor:
    """Executes a hot change of one run."""

    execution: Execution
    control: Control
    log: RunLog

    def change(self, old: Plan, new: Plan, *, preempt: bool, kept: VersionSnapshot) -> ChangeReport:
        """Replace the nodes of the run by those of the new version.

        Raises:
            ControlError: the run cannot continue in the new version; it continues unchanged.
        """
        report = self._plan(old, new, preempt=preempt)
        if report.refusals:
            can_preempt = not preempt and not self._plan(old, new, preempt=True).refusals
            hint = _PREEMPT_HINT if can_preempt else "the run continues with the old version"
            raise ControlError("; ".join(report.refusals), hint=hint)
        execution = self.execution
        for path in report.removed:
            # Merged before the change: their writes persist, and a crash in between loses nothing.
            container, _, name = path.rpartition("/")
            if (branching := execution.branching.get(container)) is not None:
                branching.merge(name)
        execution.replaced = dict(definitions(new))
        self.log.changed(new.document_hash, report, preempt=preempt, kept=kept)
        for path in report.removed:
            # Its container preempts it; a branch held by a pause would never clean up.
            execution.branch_holds.let_clean_up(path)
        for branching in execution.branching.values():
            branching.wake()
        for path in report.restarted:
            self.control.restart(path)
        execution.gate.arm()
        return report

    def _plan(self, old: Plan, new: Plan, *, preempt: bool) -> ChangeReport:
        gate = self.execution.gate
        # A branch that an earlier change removed and that still cleans up is in neither version.
        active = {path: old.nodes[path] for path in self.execution.activity.nodes if path in old.nodes}
        waiting = {each.path: each.outcome for each in gate.waiting.values() if each.path in old.nodes}
        is_held = gate.paused or _locked(active, waiting, gate.locks)
        return plan_change(old, new, active=active, waiting=waiting, still=is_held, preempt=preempt)


def _locked(active: Mapping[str, Node], waiting: Mapping[str, str], locks: set[str]) -> bool:
    """Return whether every active state waits behind a lock, its own or that of a container around it."""
    leaves = [path for path, node in active.items() if not node.work.children]
    return not leaves and any(path in locks for path in waiting)
