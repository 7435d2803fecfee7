"""The smallest change from nominal with which a run still fails: the configuration that shows a weakness best.

First each factor is set back to its nominal value (Zeller's delta debugging, one factor at a time until none can be set
back); then each number that is left is moved towards its nominal value by bisection. Only runs decide, so the result
fails for certain; with other seeds it may not.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass

import msgspec

from engine.document.sweep import Factor
from engine.errors import ControlError
from engine.sweep.configuration import Configuration
from engine.sweep.trial_result import TrialResult

_BISECTIONS = 6
"""Halvings of the distance to the nominal value: the boundary is then known to 1/64 of it."""
Execute = Callable[[Configuration], TrialResult]


@dataclass(frozen=True, kw_only=True)
class Shrunk:
    """A failing configuration with as few and as small changes from nominal as were found."""

    result: TrialResult
    changed: Mapping[str, tuple[object, object]]
    """The factors that still differ: their nominal value and the one that fails."""
    runs: int
    """The runs that it took."""
    passes: Mapping[str, object]
    """By factor the value nearest to the failing one, on the nominal side, with which the run did not fail so."""


def shrink(
    failing: TrialResult,
    factors: Mapping[str, Factor],
    nominal: Mapping[str, object],
    execute: Execute,
    *,
    same: Callable[[TrialResult, TrialResult], bool] | None = None,
    most_runs: int = 200,
) -> Shrunk:
    """Return the smallest change from nominal that still fails like a run.

    Args:
        failing: A run that did not succeed.
        factors: The factors of its sweep; others keep their value.
        nominal: The nominal value of each.
        execute: Executes a configuration.
        same: Whether a run fails like the first one; by default where it ended with the same outcome or status.
        most_runs: The runs after which the smallest one found so far is returned.

    Raises:
        ControlError: the run succeeded.
    """
    if failing.success:
        raise ControlError(
            f"configuration {failing.configuration.number} succeeds",
            where="shrink",
            hint="choose one that fails: `flexcell sweep report` lists them",
        )
    search = _Search(failing, factors, nominal, execute, same or same_outcome, most_runs)
    search.set_back()
    search.move_back()
    return search.found()


class _Search:
    def __init__(
        self,
        failing: TrialResult,
        factors: Mapping[str, Factor],
        nominal: Mapping[str, object],
        execute: Execute,
        same: Callable[[TrialResult, TrialResult], bool],
        most_runs: int,
    ) -> None:
        self._first = self._best = failing
        self._factors = factors
        self._nominal = nominal
        self._execute = execute
        self._same = same
        self._left = most_runs
        self._runs = 0
        self._passes: dict[str, object] = {}

    @property
    def _values(self) -> Mapping[str, object]:
        return self._best.configuration.values

    def _varied(self) -> list[str]:
        return [name for name in self._factors if name != "seed" and self._values.get(name) != self._nominal[name]]

    def set_back(self) -> None:
        """Set factors back to nominal, all that can be at once and then one by one, until none can."""
        everything = {name: self._nominal[name] for name in self._varied()}
        if len(everything) > 1 and self._fails(everything):
            return
        progress = True
        while progress:
            progress = False
            for name in self._varied():
                value = self._nominal[name]
                if self._fails({name: value}):
                    progress = True
                else:
                    self._passes[name] = value

    def move_back(self) -> None:
        """Move numbers towards nominal as far as the run still fails."""
        for name in self._varied():
            factor = self._factors[name]
            good, bad = self._nominal[name], self._values[name]
            if factor.values is not None or not isinstance(good, int | float) or not isinstance(bad, int | float):
                continue
            for _ in range(_BISECTIONS):
                middle = (good + bad) / 2.0
                value = round(middle) if factor.integer else middle
                if value in (good, bad):
                    break
                if self._fails({name: value}):
                    bad = value
                else:
                    good = value
                    self._passes[name] = value

    def found(self) -> Shrunk:
        """Return the smallest failing configuration."""
        changed = {name: (self._nominal[name], self._values[name]) for name in self._varied()}
        return Shrunk(
            result=self._best,
            changed=changed,
            runs=self._runs,
            passes={name: value for name, value in self._passes.items() if name in changed},
        )

    def _fails(self, values: Mapping[str, object]) -> bool:
        """Execute the best configuration with other values; it is the new best one where it fails like the first."""
        if not self._left:
            return False
        self._left -= 1
        self._runs += 1
        configuration = msgspec.structs.replace(
            self._best.configuration, values={**self._best.configuration.values, **values}
        )
        result = self._execute(configuration)
        if result.success or not self._same(self._first, result):
            return False
        self._best = result
        return True


def same_outcome(first: TrialResult, other: TrialResult) -> bool:
    """Return whether two runs ended with the same outcome or status."""
    return first.label == other.label


def same_cause(first: TrialResult, other: TrialResult) -> bool:
    """Return whether two runs ended alike and from the same root cause; numbers in its message may differ."""
    return same_outcome(first, other) and first.cause_key == other.cause_key
