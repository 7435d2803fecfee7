"""What becomes of nodes that were asked to stop and are still cleaning up."""

from __future__ import annotations

import asyncio
from typing import Any

from engine.preemption import OverduePolicy
from engine.runtime.nodes.execution import Execution


def overdue_policy(execution: Execution, path: str) -> OverduePolicy:
    """Return the policy that logs nodes inside `path` with overdue clean-up, and finally abandons them."""

    def report(late: str, waited_s: float) -> None:
        execution.recorder.log(late, f"asked to stop {waited_s:g} s ago and still cleaning up", level="warning")

    def abandon(task: asyncio.Task[Any], waited_s: float) -> None:
        execution.abandon(task, task.get_name(), waited_s)

    # The innermost level abandons first, or every level around it would be abandoned with it.
    grace_s = 0.1 * max(0, 20 - path.count("/"))
    return OverduePolicy(
        report=report,
        abandon=abandon,
        abandon_after_s=execution.abandon_after_s + grace_s,
        stands_still=execution.branch_holds.stands_still,
    )
