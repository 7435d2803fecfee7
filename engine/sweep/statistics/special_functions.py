"""The functions of scipy that statistics need, on plain numbers: scipy's own types are partial."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any, cast

from scipy import optimize, special, stats

_OPTIMIZE, _SPECIAL, _STATS = cast("Any", optimize), cast("Any", special), cast("Any", stats)


def log_beta(first: float, second: float) -> float:
    """Return the logarithm of the beta function."""
    return float(_SPECIAL.betaln(first, second))


def beta_quantile(share: float, first: float, second: float) -> float:
    """Return the number below which this share of a beta distribution lies."""
    return float(_STATS.beta.ppf(share, first, second))


def root(function: Callable[[float], float], low: float, high: float) -> float:
    """Return where a function is 0 between two numbers at which its signs differ, to 1e-12 (Brent's method)."""
    return float(_OPTIMIZE.brentq(function, low, high, xtol=1e-12))


def rank_correlation(first: Sequence[float], second: Sequence[float]) -> float:
    """Return the rank correlation of Spearman; NaN where a sequence does not vary."""
    return float(_STATS.spearmanr(first, second).statistic)
