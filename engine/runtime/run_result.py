"""The result of a run."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from engine.errors import Cause


@dataclass(frozen=True, kw_only=True)
class RunResult:
    """Result of a run: `status` is finished, stopped or errored; `success` only for a declared success outcome."""

    run: str
    behavior: str
    status: str
    outcome: str | None
    success: bool
    cause: Cause | None
    duration_s: float
    userdata: Mapping[str, object]
    stood_in_for: tuple[str, ...] = ()
    """The nodes that a test replaced by substitutes."""
    abandoned: tuple[str, ...] = ()
    """States that did not end when preempted; their devices may still move and stay leased."""
