"""How many runs a search needs to find a planted failure, beside a random design, and whether its estimates hold.

    python -m benchmarks.failure_search [--seeds 100] [--most 20000] [--optuna 10] [--unguided 0]

A planted case has a rule instead of a behavior: it fails in a known region of known probability, and a run that does
not has a number that says how far from the region it is, as the clearance of an arm would. The first table has the runs
until the first failure: the median of a random design is ln 2 / probability. The second one executes searches of a
fixed number of runs, and compares their estimates of the failure probability and their intervals with the truth.
With `--unguided`, so many searches of each case have no number (`towards: failure`); they take the longest.
"""

from __future__ import annotations

import argparse
import math
import statistics
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path

import msgspec

from engine.document.sweep import Sweep, parse_sweep
from engine.sweep import Configuration, TrialResult
from engine.sweep.search.failure_probability import failure_probability
from engine.sweep.search.search_plan import SearchPlan

Values = Mapping[str, object]


@dataclass(frozen=True, kw_only=True)
class PlantedCase:
    """A rule that fails where its distance, in parts of the written range, is at most 0."""

    name: str
    probability: float
    factors: Mapping[str, object]
    distance: Callable[[Values], float]
    misleading: bool = False
    """Whether runs have a number that says nothing of the distance."""

    def result(self, configuration: Configuration) -> TrialResult:
        """Return how a configuration ends."""
        distance = self.distance(configuration.values)
        number = configuration.seed % 997 / 997 if self.misleading else max(distance, 0.0)
        return TrialResult(
            configuration=configuration,
            status="finished",
            outcome="missed" if distance <= 0.0 else "done",
            success=distance > 0.0,
            outputs={"distance": number},
        )

    def sweep(self, seed: int, **search: object) -> Sweep:
        """Return a sweep that searches for its failures."""
        document = {
            "flexcell": 1,
            "behavior": "planted.yaml",
            "factors": self.factors,
            "seed": seed,
            "search": {"towards": "least distance", **search},
        }
        return parse_sweep(msgspec.json.encode(document), file=Path("planted.sweep.yaml"))


def _of(values: Values, name: str) -> float:
    return float(str(values[f"parameters.{name}"]))


def _ball(values: Values) -> float:
    centre = {"a": 0.8, "b": 0.3, "c": 0.6}
    return math.dist([_of(values, each) for each in centre], list(centre.values())) - 0.0620


def _slab(values: Values) -> float:
    # Between the quantiles 0.9 and 0.901 of the normal distribution.
    return max(1.281552 - _of(values, "a"), _of(values, "a") - 1.287271)


def _corner(values: Values) -> float:
    # The largest tenth of each of them.
    mass, count = math.log(_of(values, "a")) / math.log(100.0), _of(values, "c")
    return max(0.9 - mass, (1.281552 - _of(values, "b")) / 4.0, (10.0 - count) / 10.0)


def _value(values: Values) -> float:
    if values["parameters.kind"] != "g":
        return 1.0 + 0.1 * (1.0 - _of(values, "a"))
    return 0.98 - _of(values, "a")


_UNIT = {"uniform": [0.0, 1.0]}
CASES = (
    PlantedCase(
        name="a ball in three factors",
        probability=4.0 / 3.0 * math.pi * 0.0620**3,
        factors={"parameters.a": _UNIT, "parameters.b": _UNIT, "parameters.c": _UNIT},
        distance=_ball,
    ),
    PlantedCase(
        name="a thin slab of one of four",
        probability=0.001,
        factors={
            "parameters.a": {"normal": {"deviation": 1.0}},
            "parameters.b": _UNIT,
            "parameters.c": _UNIT,
            "parameters.d": _UNIT,
        },
        distance=_slab,
    ),
    PlantedCase(
        name="a corner of three",
        probability=0.001,
        factors={
            "parameters.a": {"log_uniform": [1.0, 100.0]},
            "parameters.b": {"normal": {"deviation": 1.0}},
            "parameters.c": {"uniform": [1, 10], "integer": True},
        },
        distance=_corner,
    ),
    PlantedCase(
        name="one bad value of ten, and a tail",
        probability=0.002,
        factors={"parameters.kind": {"values": list("abcdefghij")}, "parameters.a": _UNIT},
        distance=_value,
    ),
    PlantedCase(
        name="a corner, with a number that misleads",
        probability=0.01,
        factors={"parameters.a": _UNIT, "parameters.b": _UNIT},
        distance=lambda values: 0.9 - min(_of(values, "a"), _of(values, "b")),
        misleading=True,
    ),
)


def searched(case: PlantedCase, sweep: Sweep) -> SearchPlan:
    """Return a search after its last batch."""
    plan = SearchPlan(sweep)
    while batch := plan.due():
        plan.take([case.result(point.configuration) for point in batch])
    return plan


def runs_to_first(case: PlantedCase, seed: int, **search: object) -> int:
    """Return the runs of a search up to its first failure, or all that it has."""
    return len(searched(case, case.sweep(seed, stop_after=1, **search)).steps)


def first_failures(seeds: int, most: int, optuna_seeds: int) -> None:
    """Print the first table."""
    print(
        f"| planted | probability | random, median | cross-entropy, median of {seeds} | 95 % | ratio | optuna | ratio |"
    )
    print("|---|--:|--:|--:|--:|--:|--:|--:|")
    for case in CASES:
        found = sorted(runs_to_first(case, seed, runs=most) for seed in range(seeds))
        middle, p95 = statistics.median(found), found[math.ceil(0.95 * seeds) - 1]
        random_median = math.log(2.0) / case.probability
        others = [runs_to_first(case, seed, runs=400, method="optuna") for seed in range(optuna_seeds)]
        other = statistics.median(others) if others else math.nan
        print(
            f"| {case.name} | {case.probability:.4f} | {random_median:.0f} | {middle:.0f} | {p95} | "
            f"{random_median / middle:.1f} | {other:.0f} | {random_median / other:.1f} |"
        )


def unguided_failures(seeds: int, most: int) -> None:
    """Print the runs until the first failure of searches without a number."""
    print(f"| planted | random, median | without a number, median of {seeds} |")
    print("|---|--:|--:|")
    for case in CASES:
        found = [runs_to_first(case, seed, runs=most, towards="failure") for seed in range(seeds)]
        print(f"| {case.name} | {math.log(2.0) / case.probability:.0f} | {statistics.median(found):.0f} |")


def estimates(seeds: int, runs: int) -> None:
    """Print the second table."""
    print(f"{seeds} searches of {runs} runs\n")
    print("| planted | probability | mean estimate | its error | deviation | at random | intervals that miss |")
    print("|---|--:|--:|--:|--:|--:|--:|")
    for case in CASES:
        found = [failure_probability(searched(case, case.sweep(seed, runs=runs)).steps, runs) for seed in range(seeds)]
        values = [each.estimate for each in found if each is not None]
        missed = sum(not each.interval.low <= case.probability <= each.interval.high for each in found if each)
        spread = statistics.stdev(values)
        plain = math.sqrt(case.probability * (1.0 - case.probability) / runs)
        print(
            f"| {case.name} | {case.probability:.4f} | {statistics.mean(values):.5f} | "
            f"{spread / math.sqrt(seeds):.5f} | {spread:.5f} | {plain:.5f} | {missed} |"
        )


def main() -> None:
    """Print the tables."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--seeds", type=int, default=100)
    parser.add_argument("--most", type=int, default=20000)
    parser.add_argument("--optuna", type=int, default=10)
    parser.add_argument("--runs", type=int, default=400)
    parser.add_argument("--unguided", type=int, default=0)
    options = parser.parse_args()
    first_failures(options.seeds, options.most, options.optuna)
    print()
    estimates(options.seeds, options.runs)
    if options.unguided:
        print()
        unguided_failures(options.unguided, options.most)


if __name__ == "__main__":
    main()
