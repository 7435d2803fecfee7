"""A search as one batch after the other: which configurations are due, and what was learned of those before."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from engine.document.sweep import Sweep
from engine.sweep.execution.trial_result import TrialResult
from engine.sweep.search.cross_entropy import CrossEntropySampler
from engine.sweep.search.sampler import ScoredPoint, SearchPoint, SearchSampler
from engine.sweep.search.target import SearchTarget, is_failure


@dataclass(frozen=True)
class SearchStep:
    """A point of a search and its result."""

    point: SearchPoint
    result: TrialResult


class SearchPlan:
    """The batches of a search: `due` is what to execute next, `take` receives its results, in its order.

    What is due depends on the results of the batches before, and not on when or where they were executed.

    Args:
        sweep: A sweep with a search.
    """

    def __init__(self, sweep: Sweep) -> None:
        spec = sweep.document.search
        assert spec is not None
        self.spec = spec
        self.target = SearchTarget.parse(spec.towards)
        self.steps: list[SearchStep] = []
        """Those that have a result, in the order of their numbers; the search may have ended within its last batch."""
        self._where = sweep.source.position(("search", "towards"))
        self._sampler = _new_sampler(sweep)
        self._batch: Sequence[SearchPoint] = ()

    @property
    def failures(self) -> int:
        """The number of runs that failed."""
        return sum(is_failure(step.result) for step in self.steps)

    @property
    def is_satisfied(self) -> bool:
        """Whether as many failures are found as the search is for."""
        return self.spec.stop_after is not None and self.failures >= self.spec.stop_after

    def due(self) -> Sequence[SearchPoint]:
        """Return the next batch; empty where the search has ended."""
        first = len(self.steps)
        if self.is_satisfied or first >= self.spec.runs:
            return ()
        self._batch = self._sampler.propose(range(first, first + self.spec.batch))
        return self._batch[: self.spec.runs - first]

    def take(self, results: Sequence[TrialResult]) -> None:
        """Take the results of what is due, from its first one on; fewer than are due end the search.

        Raises:
            FlexcellError: no run has the number that is searched for.
        """
        taken = [SearchStep(point, result) for point, result in zip(self._batch, results, strict=False)]
        for step in taken:
            if self.is_satisfied:
                return
            self.steps.append(step)
        self.target.require_known((step.result for step in taken), where=self._where)
        if len(taken) == len(self._batch):
            self._sampler.learn([ScoredPoint(step.point, self.target.score(step.result)) for step in taken])


def _new_sampler(sweep: Sweep) -> SearchSampler:
    document = sweep.document
    assert document.search is not None
    if document.search.method == "optuna":
        # An extra that other sweeps do without.
        from engine.sweep.search.optuna_sampler import OptunaSampler

        return OptunaSampler(document.factors, document.search, seed=document.seed)
    return CrossEntropySampler(document.factors, document.search, seed=document.seed)
