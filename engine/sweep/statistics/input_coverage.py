"""How much of what is varied the runs have covered: parts of each factor and of each pair, and the largest gap.

A distribution has ten equally likely parts, so that a part without a run is as surprising in the tail as in the middle.
A list has a part for each value. Of a pair, every part of one with every part of the other counts.
"""

from __future__ import annotations

import itertools
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from engine.document.sweep import Factor
from engine.sweep.design.distributions import share_of, value_at

_PARTS = 10


@dataclass(frozen=True, kw_only=True)
class FactorCoverage:
    """The parts of one factor in which there is a run."""

    address: str
    parts: int
    covered: int
    gap: tuple[float, float] | None
    """The likeliest range of its numbers without a run; None for a list of values."""
    gap_share: float | None
    """The probability of a value in that range."""

    @property
    def share(self) -> float:
        """The share of its parts in which there is a run."""
        return self.covered / self.parts


@dataclass(frozen=True, kw_only=True)
class PairCoverage:
    """The pairs of parts of two factors in which there is a run."""

    first: str
    second: str
    parts: int
    covered: int

    @property
    def share(self) -> float:
        """The share of pairs of parts in which there is a run."""
        return self.covered / self.parts


@dataclass(frozen=True, kw_only=True)
class InputCoverage:
    """What a set of runs has covered of all factors."""

    factors: Sequence[FactorCoverage]
    pairs: Sequence[PairCoverage]
    """Those of which the least is covered first."""


def input_coverage(factors: Mapping[str, Factor], runs: Sequence[Mapping[str, object]]) -> InputCoverage:
    """Return what runs have covered.

    Args:
        factors: What is varied, by address.
        runs: The value of each factor in each run, by address.
    """
    parts = {address: _parts_of(factor, [run[address] for run in runs]) for address, factor in factors.items()}
    counts = {address: _part_count(factor) for address, factor in factors.items()}
    pairs = [
        PairCoverage(
            first=first,
            second=second,
            parts=counts[first] * counts[second],
            covered=len(
                {
                    each
                    for each in zip(parts[first], parts[second], strict=True)
                    if each[0] is not None and each[1] is not None
                }
            ),
        )
        for first, second in itertools.combinations(factors, 2)
    ]
    return InputCoverage(
        factors=[
            _factor_coverage(address, factor, [run[address] for run in runs], parts[address])
            for address, factor in factors.items()
        ],
        pairs=sorted(pairs, key=lambda each: each.share),
    )


def _factor_coverage(
    address: str, factor: Factor, values: Sequence[object], parts: Sequence[int | None]
) -> FactorCoverage:
    low, high = _largest_gap(factor, values) if factor.values is None else (0.0, 0.0)
    return FactorCoverage(
        address=address,
        parts=_part_count(factor),
        covered=len(set(parts) - {None}),
        gap=(_number(factor, low), _number(factor, high)) if factor.values is None else None,
        gap_share=high - low if factor.values is None else None,
    )


def _part_count(factor: Factor) -> int:
    return len(dict.fromkeys(map(_label, factor.values))) if factor.values is not None else _PARTS


def _parts_of(factor: Factor, values: Sequence[object]) -> list[int | None]:
    """Return the part in which each value lies; None for a value that the factor does not have."""
    if factor.values is not None:
        numbers = {label: index for index, label in enumerate(dict.fromkeys(map(_label, factor.values)))}
        return [numbers.get(_label(value)) for value in values]
    shares = [share_of(factor, value) for value in values]
    return [min(int(share * _PARTS), _PARTS - 1) if share is not None else None for share in shares]


def _largest_gap(factor: Factor, values: Sequence[object]) -> tuple[float, float]:
    """Return the ends of the longest stretch of probability without a value, the ends of the distribution included."""
    shares = sorted(share for value in values if (share := share_of(factor, value)) is not None)
    return max(itertools.pairwise((0.0, *shares, 1.0)), key=lambda gap: gap[1] - gap[0])


def _number(factor: Factor, share: float) -> float:
    value = value_at(factor, share)
    assert isinstance(value, int | float)
    return float(value)


def _label(value: object) -> str:
    return f"{value:g}" if isinstance(value, float) else str(value)
