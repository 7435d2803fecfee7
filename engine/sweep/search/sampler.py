"""The contract of what proposes the configurations of a search, and the points that it proposes."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Protocol

from engine.document.sweep import Factor
from engine.sweep.design.configuration import Configuration
from engine.sweep.design.distributions import value_at


@dataclass(frozen=True, kw_only=True)
class SearchPoint:
    """A configuration of a search, with where it is in the distributions that are written."""

    configuration: Configuration
    batch: int
    """From 0."""
    shares: Sequence[float]
    """For each factor the probability of values below its own, from 0 to 1."""
    weight: float | None
    """How much more likely the written distributions draw it than the search does; None where that is unknown."""
    most_weight: float
    """What no weight of its batch exceeds."""


@dataclass(frozen=True)
class ScoredPoint:
    """A point that has been executed: the lower its score the nearer to failure, -inf where it failed."""

    point: SearchPoint
    score: float


class SearchSampler(Protocol):
    """Proposes the points of one batch after the other; the same ones whenever the same is learned."""

    def propose(self, numbers: Sequence[int]) -> Sequence[SearchPoint]:
        """Return a point for each of these numbers of configurations."""
        ...

    def learn(self, batch: Sequence[ScoredPoint]) -> None:
        """Take what the batch that was proposed last has shown."""
        ...


def values_at(factors: Mapping[str, Factor], shares: Sequence[float]) -> dict[str, object]:
    """Return the value of each factor at these probabilities."""
    return {name: value_at(factor, share) for (name, factor), share in zip(factors.items(), shares, strict=True)}
