"""Batches that the tree-structured Parzen estimator of optuna proposes: a Bayesian search, for costly runs.

It proposes near to what is best so far and does not tell with which probability, so that its runs estimate no rate.
"""

from __future__ import annotations

import sys
from collections.abc import Mapping, Sequence

from engine.document.sweep import Factor, SearchSpec
from engine.errors import FlexcellError
from engine.sweep.design.designs import configuration_of, random_shares
from engine.sweep.search.sampler import ScoredPoint, SearchPoint, values_at

try:
    import optuna
    from optuna.distributions import BaseDistribution, CategoricalDistribution, FloatDistribution
    from optuna.trial import Trial, create_trial
except ImportError as error:
    raise FlexcellError(
        "the method `optuna` needs the package optuna", where="search", hint="pip install 'flexcell[optuna]'"
    ) from error


class OptunaSampler:
    """Proposes batches by asking a study, which is told the results of each batch in the order of its numbers.

    Args:
        factors: The factors.
        spec: The settings.
        seed: The seed of the sweep.
    """

    def __init__(self, factors: Mapping[str, Factor], spec: SearchSpec, *, seed: int) -> None:
        self._factors = factors
        self._seed = seed
        self._batch = 0
        self._asked: list[Trial] = []
        self._distributions: dict[str, BaseDistribution] = {
            name: FloatDistribution(0.0, 1.0)
            if factor.values is None
            else CategoricalDistribution(tuple(range(len(factor.values))))
            for name, factor in factors.items()
        }
        optuna.logging.set_verbosity(optuna.logging.WARNING)
        sampler = optuna.samplers.TPESampler(seed=seed % 2**32, n_startup_trials=spec.batch)
        self._study = optuna.create_study(sampler=sampler)

    def propose(self, numbers: Sequence[int]) -> Sequence[SearchPoint]:
        """Return a point for each number; those of the first batch are those of a random design."""
        if self._batch == 0:
            return [self._point(number, random_shares(self._seed, number, len(self._factors))) for number in numbers]
        self._asked = [self._study.ask(self._distributions) for _ in numbers]
        return [
            self._point(number, [self._share(name, trial.params[name]) for name in self._factors])
            for number, trial in zip(numbers, self._asked, strict=True)
        ]

    def learn(self, batch: Sequence[ScoredPoint]) -> None:
        """Tell the study the scores of a batch."""
        for index, each in enumerate(batch):
            # The study compares scores only, and takes no infinite ones.
            score = min(max(each.score, -sys.float_info.max), sys.float_info.max)
            if self._batch == 0:
                params = {
                    name: self._param(factor, share)
                    for (name, factor), share in zip(self._factors.items(), each.point.shares, strict=True)
                }
                self._study.add_trial(create_trial(params=params, distributions=self._distributions, value=score))
            else:
                self._study.tell(self._asked[index], score)
        self._batch += 1

    def _share(self, name: str, param: float) -> float:
        values = self._factors[name].values
        return param if values is None else (param + 0.5) / len(values)

    def _param(self, factor: Factor, share: float) -> float | int:
        return share if factor.values is None else min(int(share * len(factor.values)), len(factor.values) - 1)

    def _point(self, number: int, shares: Sequence[float]) -> SearchPoint:
        return SearchPoint(
            configuration=configuration_of(self._seed, number, values_at(self._factors, shares)),
            batch=self._batch,
            shares=shares,
            weight=None,
            most_weight=1.0,
        )
