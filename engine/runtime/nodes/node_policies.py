"""Policies of a node: timeout, retry and guard."""

from __future__ import annotations

from dataclasses import dataclass

from engine.document.expression.expression import Template


@dataclass(frozen=True, kw_only=True)
class TimeoutPolicy:
    """Preempt the node after `after_s` and go to `target`."""

    after_s: float
    target: str


@dataclass(frozen=True, kw_only=True)
class RetryPolicy:
    """Retry the node up to `times` times on these outcomes or errors; the wait `backoff_s` doubles each time."""

    times: int
    backoff_s: float = 0.0
    outcomes: tuple[str, ...] = ()
    errors: bool = True


@dataclass(frozen=True, kw_only=True)
class GuardPolicy:
    """Enter the node only when `when` is true, else divert to `target`."""

    when: Template
    target: str
