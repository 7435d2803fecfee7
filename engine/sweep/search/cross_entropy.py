"""Cross-entropy: each batch is drawn around the runs that came nearest to failure (Rubinstein 1999).

Sources: R. Rubinstein (1999), "The cross-entropy method for combinatorial and continuous optimization"; P.-T. de Boer,
D. Kroese, S. Mannor and R. Rubinstein (2005), "A tutorial on the cross-entropy method". The share of each batch that is
drawn as written makes it a defensive mixture (T. Hesterberg 1995): no weight of a run exceeds 1 / share.
"""

from __future__ import annotations

import math
import random
from collections.abc import Mapping, Sequence

from engine.document.sweep import Factor, SearchSpec
from engine.sweep.design.designs import configuration_of, random_shares
from engine.sweep.search.proposal import FactorProposal, written_proposals
from engine.sweep.search.sampler import ScoredPoint, SearchPoint, values_at

_LEAST_ELITES = 4
_PATIENCE = 3
"""Batches without a nearer run after which the search begins anew: its number may mislead, or it is in a dead end."""
_WIDE = 1.5
"""The deviation while nothing is known, and with which it begins anew: many behaviors fail at the ends of factors."""


class CrossEntropySampler:
    """Draws batches from a mixture of the written distributions and of those that were learned.

    Args:
        factors: The factors.
        spec: The settings.
        seed: The seed of the sweep.
    """

    def __init__(self, factors: Mapping[str, Factor], spec: SearchSpec, *, seed: int) -> None:
        self._factors = factors
        self._spec = spec
        self._seed = seed
        self._proposals: Sequence[FactorProposal] = written_proposals(factors)
        self._batch = 0
        self._nearest = math.inf
        self._stale = 0
        self._known: list[ScoredPoint] = []

    def propose(self, numbers: Sequence[int]) -> Sequence[SearchPoint]:
        """Return a point for each number; where it is drawn as written, that of a random design."""
        return [self._point(number) for number in numbers]

    def learn(self, batch: Sequence[ScoredPoint]) -> None:
        """Move the distributions to the runs of all batches that are nearest to failure."""
        self._known += batch
        self._batch += 1
        nearest = min(each.score for each in self._known)
        if nearest < self._nearest or nearest == -math.inf:
            self._nearest, self._stale = nearest, 0
        else:
            self._stale += 1
        if self._stale >= _PATIENCE:
            self._nearest, self._stale = math.inf, 0
            self._known.clear()
            self._proposals = written_proposals(self._factors, deviation=_WIDE)
            return
        elites, weights = self._elites()
        if not elites:
            self._proposals = written_proposals(self._factors, deviation=_WIDE)
        else:
            columns = zip(*(each.point.shares for each in elites), strict=True)
            self._proposals = tuple(
                proposal.fitted(list(shares), weights)
                for proposal, shares in zip(self._proposals, columns, strict=True)
            )

    def _elites(self) -> tuple[list[ScoredPoint], list[float]]:
        """Return the points to draw around and their weights."""
        count = max(round(self._spec.elite * self._spec.batch), _LEAST_ELITES)
        ordered = sorted(self._known, key=lambda each: (each.score, -each.point.configuration.number))
        failed = [each for each in ordered if each.score == -math.inf]
        if len(failed) > count:
            # Enough of them to know where failures are likely, and not only where there is one.
            return failed, [each.point.weight or 1.0 for each in failed]
        # A run that is as far as the farthest says nothing.
        farthest = ordered[-1].score
        nearest = [each for each in ordered if each.score < farthest][:count]
        return nearest, [1.0] * len(nearest)

    def _point(self, number: int) -> SearchPoint:
        drawn = random_shares(self._seed, number, len(self._factors))
        share = self._spec.random_share if self._batch else 1.0
        written = self._choice(number) < share
        moved = [proposal.draw(each) for proposal, each in zip(self._proposals, drawn, strict=True)]
        shares = drawn if written else moved
        return SearchPoint(
            configuration=configuration_of(self._seed, number, values_at(self._factors, shares)),
            batch=self._batch,
            shares=shares,
            weight=self._weight(shares, share),
            most_weight=1.0 / share,
        )

    def _weight(self, shares: Sequence[float], written_share: float) -> float:
        ratio = sum(proposal.log_density(each) for proposal, each in zip(self._proposals, shares, strict=True))
        return 1.0 / (written_share + (1.0 - written_share) * math.exp(min(ratio, 700.0)))

    def _choice(self, number: int) -> float:
        return random.Random(f"{self._seed}/{number}/search").random()  # noqa: S311 - no secret
