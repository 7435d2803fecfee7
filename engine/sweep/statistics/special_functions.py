"""The functions of scipy that statistics need, on plain numbers: scipy's own types are partial.

scipy is loaded with its first use: that takes longer than all else, and those who only name what a summary consists of
(the server of the page describes its bodies) do not need it.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import cache
from importlib import import_module
from typing import Any


@cache
def _scipy(part: str) -> Any:
    return import_module(f"scipy.{part}")


def log_beta(first: float, second: float) -> float:
    """Return the logarithm of the beta function."""
    return float(_scipy("special").betaln(first, second))


def beta_quantile(share: float, first: float, second: float) -> float:
    """Return the number below which this share of a beta distribution lies."""
    return float(_scipy("stats").beta.ppf(share, first, second))


def root(function: Callable[[float], float], low: float, high: float) -> float:
    """Return where a function is 0 between two numbers at which its signs differ, to 1e-12 (Brent's method)."""
    return float(_scipy("optimize").brentq(function, low, high, xtol=1e-12))


def rank_correlation(first: Sequence[float], second: Sequence[float]) -> float:
    """Return the rank correlation of Spearman; NaN where a sequence does not vary."""
    return float(_scipy("stats").spearmanr(first, second).statistic)
