"""The distributions from which cross-entropy draws: they move from the written ones to where runs fail.

A number is drawn in the space in which its written distribution is the standard normal one, whatever it is: the ends of
a range and the tails of a normal distribution are equally far away there. A list of values has probabilities.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from statistics import NormalDist

from engine.document.sweep import Factor

_STANDARD = NormalDist()
_LEAST_SHARE = 1e-12
_LEAST_DEVIATION = 1e-4
_FEW = 3
"""Points from which on a deviation is learned."""
_LEARNED = 0.7
"""The share of what a batch shows in the next distribution; the rest is the last one."""
_EVEN = 0.2
"""The share of equal probabilities in those of a list: no value is given up."""


@dataclass(frozen=True, kw_only=True)
class NumberProposal:
    """A normal distribution; the written one has mean 0 and deviation 1."""

    mean: float = 0.0
    deviation: float = 1.0

    def draw(self, share: float) -> float:
        """Return the share in the written distribution of the value at a share of this one."""
        return _STANDARD.cdf(self.mean + self.deviation * _STANDARD.inv_cdf(_inside(share)))

    def log_density(self, share: float) -> float:
        """Return the logarithm of the density at a written share, relative to the written distribution."""
        score = _STANDARD.inv_cdf(_inside(share))
        off = (score - self.mean) / self.deviation
        return 0.5 * (score * score - off * off) - math.log(self.deviation)

    def fitted(self, shares: Sequence[float], weights: Sequence[float]) -> NumberProposal:
        """Return the distribution moved to weighted points.

        The deviation is that from the last mean: it stays wide while the distribution moves, and gets narrow where the
        points are.
        """
        scores = [_STANDARD.inv_cdf(_inside(share)) for share in shares]
        total = sum(weights)
        mean = sum(weight * score for weight, score in zip(weights, scores, strict=True)) / total
        squares = sum(weight * (score - self.mean) ** 2 for weight, score in zip(weights, scores, strict=True))
        deviation = self.deviation
        if len(shares) >= _FEW:
            deviation = _LEARNED * math.sqrt(squares / total) + (1.0 - _LEARNED) * self.deviation
        return NumberProposal(
            mean=_LEARNED * mean + (1.0 - _LEARNED) * self.mean, deviation=max(deviation, _LEAST_DEVIATION)
        )


@dataclass(frozen=True, kw_only=True)
class ListProposal:
    """The probability of each value of a list; as written they are equal."""

    chances: Sequence[float]

    def draw(self, share: float) -> float:
        """Return the share in the written distribution of the value at a share of this one."""
        left = share
        for index, chance in enumerate(self.chances):
            if left < chance or index == len(self.chances) - 1:
                return (index + min(left / chance, 1.0 - 1e-9)) / len(self.chances)
            left -= chance
        raise AssertionError("a list has a value")

    def log_density(self, share: float) -> float:
        """Return the logarithm of the probability of the value at a written share, relative to the written one."""
        return math.log(self.chances[self._index(share)] * len(self.chances))

    def fitted(self, shares: Sequence[float], weights: Sequence[float]) -> ListProposal:
        """Return the probabilities moved to weighted points."""
        found = [0.0] * len(self.chances)
        for share, weight in zip(shares, weights, strict=True):
            found[self._index(share)] += weight
        total, even = sum(weights), 1.0 / len(self.chances)
        kept = 1.0 - _LEARNED
        moved = [_LEARNED * each / total + kept * old for each, old in zip(found, self.chances, strict=True)]
        return ListProposal(chances=tuple((1.0 - _EVEN) * each + _EVEN * even for each in moved))

    def _index(self, share: float) -> int:
        return min(int(share * len(self.chances)), len(self.chances) - 1)


FactorProposal = NumberProposal | ListProposal


def written_proposals(factors: Mapping[str, Factor], *, deviation: float = 1.0) -> tuple[FactorProposal, ...]:
    """Return the distributions as they are written; with a deviation above 1, the ends of numbers are more likely."""
    return tuple(
        NumberProposal(deviation=deviation)
        if factor.values is None
        else ListProposal(chances=(1.0 / len(factor.values),) * len(factor.values))
        for factor in factors.values()
    )


def _inside(share: float) -> float:
    return min(max(share, _LEAST_SHARE), 1.0 - _LEAST_SHARE)
