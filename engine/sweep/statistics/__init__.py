"""Intervals of success rates that may be looked at after every run, comparisons, and effects of factors."""

from engine.sweep.statistics.intervals import Interval, RatePair, difference, exact_interval, rate_interval

__all__ = ["Interval", "RatePair", "difference", "exact_interval", "rate_interval"]
