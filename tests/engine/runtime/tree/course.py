"""What came of a random tree, whoever has executed it."""

from __future__ import annotations

import json
from dataclasses import dataclass
from typing import Any

from engine.event import NodeEntered
from tests.engine.runtime.tree.run_tree import run_tree


@dataclass(frozen=True)
class Course:
    """What came of it: the final status, None when it did not end, and what was begun."""

    status: str | None
    ended_s: float
    begun: tuple[tuple[float, str], ...]
    endless: bool = False


def engine_course(document: dict[str, Any], *, until_s: float, instant_limit: int) -> Course:
    """Execute a tree with the engine."""
    told = run_tree(json.dumps(document), stop_at_s=until_s + 0.1, instant_limit=instant_limit)
    begun = tuple(
        (event.time_s, event.path.removeprefix("root/"))
        for event in told.events
        if isinstance(event, NodeEntered) and event.kind == "state" and event.time_s < until_s
    )
    result = told.result
    if result.status == "finished" and result.duration_s < until_s:
        return Course(result.outcome, result.duration_s, begun)
    endless = result.status == "errored" and "without waiting" in told.why[0]
    assert endless or result.status in ("finished", "stopped"), told.why
    return Course(None, result.duration_s if endless else until_s, begun, endless=endless)
