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

_PREEMPT_HINT = "the run goes on with the old version; `preempt` gives up what cannot go on in the new one"


@dataclass(frozen=True, kw_only=True)
class HotChangeExecutor:
    """What a change of one run takes."""

    execution: Execution
    control: Control
    log: RunLog

    def change(self, old: Plan, new: Plan, *, preempt: bool, kept: VersionSnapshot) -> ChangeReport:
        """Have the nodes of the run be those of the new version.

        Raises:
            ControlError: the run cannot go on in the new version; it goes on as it is.
        """
        report = self._planned(old, new, preempt=preempt)
        if report.refusals:
            could = not preempt and not self._planned(old, new, preempt=True).refusals
            hint = _PREEMPT_HINT if could else "the run goes on with the old version"
            raise ControlError("; ".join(report.refusals), hint=hint)
        execution = self.execution
        for path in report.removed:
            # What they have written stays: before the change, so that a crash in between loses nothing.
            container, _, name = path.rpartition("/")
            if (branching := execution.branching.get(container)) is not None:
                branching.merge(name)
        execution.replaced = dict(definitions(new))
        self.log.changed(new.document_hash, report, preempt=preempt, kept=kept)
        for path in report.removed:
            # Its container preempts it; what a pause holds would never clean up.
            execution.branch_holds.let_clean_up(path)
        for branching in execution.branching.values():
            branching.wake()
        for path in report.restarted:
            self.control.restart(path)
        execution.gate.arm()
        return report

    def _planned(self, old: Plan, new: Plan, *, preempt: bool) -> ChangeReport:
        gate = self.execution.gate
        # What an earlier change has removed and still cleans up is in no version any more.
        active = {path: old.nodes[path] for path in self.execution.activity.nodes if path in old.nodes}
        waiting = {each.path: each.outcome for each in gate.waiting.values() if each.path in old.nodes}
        still = gate.paused or _locked(active, waiting, gate.locks)
        return plan_change(old, new, active=active, waiting=waiting, still=still, preempt=preempt)


def _locked(active: Mapping[str, Node], waiting: Mapping[str, str], locks: set[str]) -> bool:
    """Tell whether every active state waits behind a lock, its own or one around it."""
    leaves = [path for path, node in active.items() if not node.work.children]
    return not leaves and any(path in locks for path in waiting)
