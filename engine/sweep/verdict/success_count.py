"""Counts results of a sweep as they arrive, and what they prove about the success rate and what is required."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence

from engine.document.requirement import Requirement
from engine.document.sweep import SweepDocument
from engine.sweep.execution.trial_result import TrialResult
from engine.sweep.statistics import Interval
from engine.sweep.verdict.judged_requirement import JudgedRequirement, Verdict, judged, share_interval, verdict_of


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
        self._required = document.requirements
        self._kept: Counter[Requirement] = Counter()
        self._missing: Counter[Requirement] = Counter()
        self._waiting: dict[int, TrialResult] = {}

    @property
    def done(self) -> int:
        """The number of results."""
        return self.labels.total()

    def add(self, result: TrialResult) -> None:
        """Count a result; each configuration is counted once by its caller."""
        self.labels[result.label] += 1
        self._waiting[result.configuration.number] = result
        while self.looked_at in self._waiting:
            self._look_at(self._waiting.pop(self.looked_at))

    @property
    def rate(self) -> float | None:
        """The share of successes among the results that are looked at; None without any."""
        return self.successes / self.looked_at if self.looked_at else None

    @property
    def interval(self) -> Interval | None:
        """The interval of the success rate; None where the design has none, or an exact one whose runs are not done."""
        return share_interval(self.successes, self.looked_at, self._document, planned=self.planned)

    @property
    def requirements(self) -> Sequence[JudgedRequirement]:
        """Each requirement and whether it is reached."""
        return [
            judged(
                requirement,
                self._document,
                kept=self._kept[requirement],
                missing=self._missing[requirement],
                runs=self.looked_at,
                planned=self.planned,
                among=len(self._required),
            )
            for requirement in self._required
        ]

    @property
    def verdict(self) -> Verdict | None:
        """Whether what is required is reached, all of it; None where nothing is required."""
        return verdict_of(self.requirements)

    @property
    def is_decided(self) -> bool:
        """Whether more runs are not needed: what is required is decided, or the interval is narrow enough."""
        width = self._document.width
        interval = self.interval if width is not None else None
        if width is not None and interval is not None and interval.width <= width:
            return True
        return self.verdict in ("passed", "failed")

    def _look_at(self, result: TrialResult) -> None:
        self.looked_at += 1
        self.successes += result.success
        numbers = result.numbers
        for each in self._required:
            self._kept[each] += each.is_kept(success=result.success, numbers=numbers)
            self._missing[each] += each.limit is not None and each.limit.name not in numbers
