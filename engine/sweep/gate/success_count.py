"""Counts results of a sweep as they arrive, and what they prove about the success rate."""

from __future__ import annotations

from collections import Counter
from typing import Literal

from engine.document.sweep import SweepDocument
from engine.sweep.execution.trial_result import TrialResult
from engine.sweep.statistics import Interval, exact_interval, rate_interval

Verdict = Literal["passed", "failed", "undecided"]


class SuccessCount:
    """The results of one sweep, counted in the order of its configurations.

    Short runs arrive first, and short runs may succeed more often: an interval of the results that happen to be there
    would be wrong. Only those without a gap before them are looked at until all are there.

    Args:
        document: The sweep.
        planned: The number of configurations.
    """

    def __init__(self, document: SweepDocument, planned: int) -> None:
        self.planned = planned
        self.labels: Counter[str] = Counter()
        """The number of results by outcome or status, also behind gaps."""
        self.looked_at = 0
        """The number of results without a gap before them."""
        self.successes = 0
        """The successes among those."""
        self._document = document
        self._waiting: dict[int, bool] = {}

    @property
    def done(self) -> int:
        """The number of results."""
        return self.labels.total()

    def add(self, result: TrialResult) -> None:
        """Count a result; each configuration is counted once by its caller."""
        self.labels[result.label] += 1
        self._waiting[result.configuration.number] = result.success
        while self.looked_at in self._waiting:
            self.successes += self._waiting.pop(self.looked_at)
            self.looked_at += 1

    @property
    def rate(self) -> float | None:
        """The share of successes among the results that are looked at; None without any."""
        return self.successes / self.looked_at if self.looked_at else None

    @property
    def interval(self) -> Interval | None:
        """The interval of the success rate; None where the design has none, or an exact one whose runs are not done."""
        document = self._document
        if document.design != "random":
            return None
        if document.interval == "anytime":
            return rate_interval(self.successes, self.looked_at, confidence=document.confidence)
        if self.looked_at < self.planned:
            return None
        return exact_interval(self.successes, self.looked_at, confidence=document.confidence)

    @property
    def verdict(self) -> Verdict | None:
        """Whether the required rate is reached; None where nothing is required."""
        required = self._document.required_rate
        if required is None:
            return None
        if self._document.design != "random":
            return self._verdict_of_all(required)
        interval = self.interval
        if interval is None:
            return "undecided"
        if interval.low >= required:
            return "passed"
        return "failed" if interval.high < required else "undecided"

    @property
    def is_decided(self) -> bool:
        """Whether more runs are not needed: the required rate is decided, or the interval is narrow enough."""
        interval, width = self.interval, self._document.width
        if width is not None and interval is not None and interval.width <= width:
            return True
        return self.verdict in ("passed", "failed")

    def _verdict_of_all(self, required: float) -> Verdict:
        if self.looked_at == self.planned:
            return "passed" if self.successes >= required * self.planned else "failed"
        most = self.planned - (self.looked_at - self.successes)
        return "failed" if most < required * self.planned else "undecided"
