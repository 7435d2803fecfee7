"""The smallest change from nominal with which a run still fails: the configuration that shows a weakness best.

First chance is taken out: the seed and the placement noise. Then factors are set back to their nominal values, in
blocks, one by one and in pairs, until none can be (Zeller's delta debugging). The numbers that are left are moved
towards their nominal values by bisection, together and one by one, and are written with as few decimals as fail. Only
runs decide, so the result fails for certain; with another seed it may not.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Literal

import msgspec

from engine.document.sweep import Factor
from engine.errors import ControlError
from engine.sweep.design.configuration import Configuration
from engine.sweep.execution.trial_result import TrialResult

_BISECTIONS = 6
"""Halvings of the distance to the nominal value: the boundary is then known to 1/64 of it."""
_TOGETHER = 4
_ROUNDED = 0.1
"""How much further from nominal, as a share of the distance, a number with fewer decimals may be."""
_ROUNDINGS = 3
_DECIMALS = 9
_NOMINAL_SEED = 0
Execute = Callable[[Configuration], TrialResult]
Same = Callable[[TrialResult, TrialResult], bool]
SameAs = Literal["outcome", "cause"]
"""What must stay the same: how a run ends, or its root cause too."""


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
    seed_matters: bool = False
    """Whether it fails with its seed and not with the nominal one."""
    placement_noise: bool = True
    """Whether it is executed with placement noise."""
    interrupted: bool = False
    """Whether it was ended before nothing smaller was left to try."""


@dataclass(frozen=True, kw_only=True)
class ShrinkProgress:
    """How far a failing run is shrunk."""

    runs: int
    most_runs: int
    step: str
    """What is tried."""
    changed: Sequence[str]
    """The factors that still differ from nominal."""


def shrink(
    failing: TrialResult,
    factors: Mapping[str, Factor],
    nominal: Mapping[str, object],
    execute: Execute,
    *,
    quiet: Execute | None = None,
    same: Same | None = None,
    most_runs: int = 200,
    show: Callable[[ShrinkProgress], None] = lambda _progress: None,
) -> Shrunk:
    """Return the smallest change from nominal that still fails like a run; Ctrl-C ends it with that found so far.

    Args:
        failing: A run that did not succeed.
        factors: The factors of its sweep; others keep their value.
        nominal: The nominal value of each.
        execute: Executes a configuration.
        quiet: Executes it without placement noise; None where there is none.
        same: Whether a run fails like the first one; by default where it ended with the same outcome or status.
        most_runs: The runs after which the smallest one found so far is returned.
        show: Called after each run.

    Raises:
        ControlError: the run succeeded.
    """
    if failing.success:
        raise ControlError(
            f"configuration {failing.configuration.number} succeeds",
            where="shrink",
            hint="choose one that fails: `flexcell sweep report` lists them",
        )
    shrinker = _Shrinker(failing, factors, nominal, execute, same or same_outcome, most_runs, show)
    try:
        shrinker.take_chance_out(quiet)
        shrinker.set_back()
        shrinker.move_back()
        shrinker.round_off()
    except KeyboardInterrupt:
        return replace(shrinker.found(), interrupted=True)
    return shrinker.found()


class _Shrinker:
    def __init__(
        self,
        failing: TrialResult,
        factors: Mapping[str, Factor],
        nominal: Mapping[str, object],
        execute: Execute,
        same: Same,
        most_runs: int,
        show: Callable[[ShrinkProgress], None],
    ) -> None:
        self._first = self._best = failing
        self._factors = factors
        self._nominal = nominal
        self._execute = execute
        self._same = same
        self._most_runs = most_runs
        self._show = show
        self._runs = 0
        self._step = ""
        self._quiet = False
        self._seed_matters = False
        self._passes: dict[str, object] = {}

    @property
    def _values(self) -> Mapping[str, object]:
        return self._best.configuration.values

    def _varied(self) -> list[str]:
        return [name for name in self._factors if name != "seed" and self._values.get(name) != self._nominal[name]]

    def take_chance_out(self, quiet: Execute | None) -> None:
        """Take the nominal seed and no placement noise, both or one of them, where the run fails so too."""
        self._step = "seed and placement noise"
        given = self._nominal.get("seed")
        seed = given if isinstance(given, int) else _NOMINAL_SEED
        own = self._best.configuration.seed
        noisy = self._execute
        for execute, each in ((quiet, seed), (quiet, own), (noisy, seed)):
            if execute is None or (execute is noisy and each == own):
                continue
            self._execute = execute
            if self._fails({}, seed=each):
                self._quiet = execute is quiet
                break
            self._execute = noisy
        self._seed_matters = self._best.configuration.seed == own != seed

    def set_back(self) -> None:
        """Set factors back to nominal: all that can be at once, blocks of them, single ones and pairs."""
        self._step = "set back to nominal"
        varied = self._varied()
        size = len(varied)
        while size > 1:
            for start in range(0, len(varied), size):
                block = [name for name in varied[start : start + size] if name in self._varied()]
                if len(block) > 1:
                    self._fails({name: self._nominal[name] for name in block})
            size //= 2
        self._set_back_one_by_one()
        if len(self._varied()) > 2:
            for pair in itertools.combinations(self._varied(), 2):
                if self._fails({name: self._nominal[name] for name in pair}):
                    self._set_back_one_by_one()
                    break

    def _set_back_one_by_one(self) -> None:
        progress = True
        while progress:
            progress = False
            for name in self._varied():
                value = self._nominal[name]
                if self._fails({name: value}):
                    progress = True
                else:
                    self._passes[name] = value

    def _numbers(self) -> Iterator[tuple[str, float, float]]:
        """Yield each number that still differs, with its nominal value and the one that fails."""
        for name in self._varied():
            good, bad = self._nominal[name], self._values[name]
            if self._factors[name].values is None and isinstance(good, int | float) and isinstance(bad, int | float):
                yield name, good, bad

    def move_back(self) -> None:
        """Move numbers towards nominal as far as the run still fails: all together, then one by one."""
        self._step = "move towards nominal"
        numbers = list(self._numbers())
        if len(numbers) > 1:
            good, bad = 0.0, 1.0
            for _ in range(_TOGETHER):
                share = (good + bad) / 2.0
                moved = {name: self._between(name, near, far, share) for name, near, far in numbers}
                good, bad = (good, share) if self._fails(moved) else (share, bad)
        for name, nominal, failing in list(self._numbers()):
            good, bad = nominal, failing
            for _ in range(_BISECTIONS):
                value = self._between(name, good, bad, 0.5)
                if value in (good, bad):
                    break
                if self._fails({name: value}):
                    bad = value
                else:
                    good = self._passes[name] = value

    def _between(self, name: str, good: float, bad: float, share: float) -> float:
        value = good + share * (bad - good)
        return round(value) if self._factors[name].integer else value

    def round_off(self) -> None:
        """Write numbers with as few decimals as fail, hardly further from nominal."""
        self._step = "round"
        before = self._best
        for name, good, bad in list(self._numbers()):
            if isinstance(bad, int):
                continue
            shorter = (each for each in _short_decimals(good, bad) if _is_possible(self._factors[name], each))
            for value in itertools.islice(shorter, _ROUNDINGS):
                if self._fails({name: value}):
                    break
        if self._best is not before:
            # A number that was moved away by rounding may have taken the place of another factor.
            nearest = dict(self._passes)
            self._set_back_one_by_one()
            self._passes.update(nearest)

    def found(self) -> Shrunk:
        """Return the smallest failing configuration."""
        changed = {name: (self._nominal[name], self._values[name]) for name in self._varied()}
        return Shrunk(
            result=self._best,
            changed=changed,
            runs=self._runs,
            passes={name: value for name, value in self._passes.items() if name in changed},
            seed_matters=self._seed_matters,
            placement_noise=not self._quiet,
        )

    def _fails(self, values: Mapping[str, object], *, seed: int | None = None) -> bool:
        """Execute the best configuration with other values; it is the new best one where it fails like the first."""
        if self._runs >= self._most_runs:
            return False
        self._runs += 1
        configuration = self._best.configuration
        changed = {**configuration.values, **values}
        if seed is not None and "seed" in changed:
            changed["seed"] = seed
        configuration = msgspec.structs.replace(
            configuration, values=changed, seed=configuration.seed if seed is None else seed
        )
        result = self._execute(configuration)
        fails = not result.success and self._same(self._first, result)
        if fails:
            self._best = result
        progress = ShrinkProgress(
            runs=self._runs, most_runs=self._most_runs, step=self._step, changed=tuple(self._varied())
        )
        self._show(progress)
        return fails


def same_outcome(first: TrialResult, other: TrialResult) -> bool:
    """Return whether two runs ended with the same outcome or status."""
    return first.label == other.label


def same_cause(first: TrialResult, other: TrialResult) -> bool:
    """Return whether two runs ended alike and from the same root cause; numbers in its message may differ."""
    return same_outcome(first, other) and first.cause_key == other.cause_key


def _short_decimals(nominal: float, value: float) -> Iterator[float]:
    """Yield numbers with fewer decimals than a value, the shortest first, a little further from nominal than it is."""
    away = math.ceil if value > nominal else math.floor
    for decimals in range(_DECIMALS):
        candidate = round(away(round(value * 10**decimals, 6)) / 10**decimals, decimals)
        if candidate == value:
            return
        if abs(candidate - value) <= _ROUNDED * abs(value - nominal):
            yield candidate


def _is_possible(factor: Factor, value: float) -> bool:
    """Return whether a value is within the limits of a factor."""
    limits = factor.uniform or factor.log_uniform
    return limits is None or limits[0] <= value <= limits[1]
