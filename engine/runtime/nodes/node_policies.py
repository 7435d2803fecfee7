"""Policies of a node: timeout, retry and guard."""

from __future__ import annotations

from dataclasses import dataclass

from engine.document.expression import Template


@dataclass(frozen=True, kw_only=True)
class TimeoutPolicy:
    """Preempt the node after `after_s` and go to `target`."""

    after_s: float
    target: str


@dataclass(frozen=True, kw_only=True)
class RetryPolicy:
    """Run the node up to `times` more, waiting `backoff_s` doubled each time, on these outcomes or errors."""

    times: int
    backoff_s: float = 0.0
    outcomes: tuple[str, ...] = ()
    errors: bool = True


@dataclass(frozen=True, kw_only=True)
class GuardPolicy:
    """Enter the node only when `when` is true, else leave it for `target`."""

    when: Template
    target: str
