"""The smallest change from nominal that still fails."""

from __future__ import annotations

from collections.abc import Callable, Mapping

import msgspec
import pytest
from hypothesis import given
from hypothesis import strategies as st

from engine.document.sweep import Factor, Normal
from engine.errors import ControlError
from engine.sweep.design.configuration import Configuration
from engine.sweep.execution.trial_result import TrialResult
from engine.sweep.shrinking import ShrinkProgress, same_cause, shrink

FACTORS = {
    "parameters.speed": Factor(uniform=(0.0, 1.0)),
    "displace.bolt.x_m": Factor(normal=Normal(deviation=0.01)),
    "cell.parts.bolt.mass_kg": Factor(uniform=(0.0, 2.0)),
    "faults": Factor(values=("none", "slip.yaml")),
    "parameters.count": Factor(uniform=(1.0, 9.0), integer=True),
}
NOMINAL: dict[str, object] = {
    "parameters.speed": 0.2,
    "displace.bolt.x_m": 0.0,
    "cell.parts.bolt.mass_kg": 1.0,
    "faults": "none",
    "parameters.count": 5,
}
Values = Mapping[str, object]


def _number(values: Values, name: str) -> float:
    return float(str(values[name]))


def _executes(fails: Callable[[Values], bool], runs: list[Configuration]) -> Callable[[Configuration], TrialResult]:
    def execute(configuration: Configuration) -> TrialResult:
        runs.append(configuration)
        bad = fails(configuration.values)
        return TrialResult(
            configuration=configuration, status="finished", outcome="bad" if bad else "good", success=not bad
        )

    return execute


def _failing(values: Values) -> TrialResult:
    configuration = Configuration(number=4, seed=11, values=values)
    return TrialResult(configuration=configuration, status="finished", outcome="bad")


FAR = {
    "parameters.speed": 0.9,
    "displace.bolt.x_m": 0.02,
    "cell.parts.bolt.mass_kg": 1.9,
    "faults": "slip.yaml",
    "parameters.count": 8,
}


def test_only_the_factor_that_matters_is_left_and_as_near_to_nominal_as_it_fails() -> None:
    runs: list[Configuration] = []
    found = shrink(
        _failing(FAR), FACTORS, NOMINAL, _executes(lambda v: _number(v, "cell.parts.bolt.mass_kg") > 1.4, runs)
    )
    assert list(found.changed) == ["cell.parts.bolt.mass_kg"]
    nominal, value = found.changed["cell.parts.bolt.mass_kg"]
    assert nominal == 1.0
    assert 1.4 < float(str(value)) < 1.4 + 0.9 / 64 + 1e-9
    assert float(str(found.passes["cell.parts.bolt.mass_kg"])) <= 1.4
    assert found.runs == len(runs) < 20
    assert {run.seed for run in runs} == {0}


def test_two_factors_that_fail_only_together_are_both_left() -> None:
    def fails(values: Values) -> bool:
        return _number(values, "parameters.speed") > 0.5 and values["faults"] == "slip.yaml"

    found = shrink(_failing(FAR), FACTORS, NOMINAL, _executes(fails, []))
    assert set(found.changed) == {"parameters.speed", "faults"}


def test_a_behavior_that_always_fails_leaves_nothing_varied() -> None:
    found = shrink(_failing(FAR), FACTORS, NOMINAL, _executes(lambda _values: True, []))
    assert (found.changed, found.seed_matters) == ({}, False)
    assert found.runs == 2


def test_a_seed_that_fails_alone_is_kept_and_named() -> None:
    def execute(configuration: Configuration) -> TrialResult:
        success = configuration.seed != 11
        return TrialResult(
            configuration=configuration, status="finished", outcome="good" if success else "bad", success=success
        )

    found = shrink(_failing(FAR), FACTORS, NOMINAL, execute)
    assert (found.changed, found.seed_matters, found.runs) == ({}, True, 2)
    assert found.result.configuration.seed == 11


@pytest.mark.parametrize("needed", [False, True], ids=["not needed", "needed"])
def test_placement_noise_is_off_unless_the_failure_needs_it(needed: bool) -> None:
    noisy: list[Configuration] = []
    quiet: list[Configuration] = []
    found = shrink(
        _failing(FAR),
        FACTORS,
        NOMINAL,
        _executes(lambda v: _number(v, "cell.parts.bolt.mass_kg") > 1.4, noisy),
        quiet=_executes(lambda v: not needed and _number(v, "cell.parts.bolt.mass_kg") > 1.4, quiet),
    )
    assert found.placement_noise is needed
    assert (len(noisy) > 0) is needed
    assert len(noisy) + len(quiet) == found.runs
    assert list(found.changed) == ["cell.parts.bolt.mass_kg"]


def test_factors_that_can_only_be_set_back_in_a_pair_are_set_back() -> None:
    def fails(values: Values) -> bool:
        """Fail where speed and x are both far or both nominal, and the mass is large."""
        fast = _number(values, "parameters.speed") > 0.5
        off = _number(values, "displace.bolt.x_m") > 0.01
        return fast == off and _number(values, "cell.parts.bolt.mass_kg") > 1.4 and values["faults"] == "slip.yaml"

    found = shrink(_failing(FAR), FACTORS, NOMINAL, _executes(fails, []))
    assert set(found.changed) == {"cell.parts.bolt.mass_kg", "faults"}


def test_what_is_left_has_few_decimals_and_stays_within_its_limits() -> None:
    def fails(values: Values) -> bool:
        return _number(values, "cell.parts.bolt.mass_kg") > 1.4 and _number(values, "parameters.speed") > 0.97

    values = {**FAR, "parameters.speed": 0.9873121, "cell.parts.bolt.mass_kg": 1.9123}
    found = shrink(_failing(values), FACTORS, NOMINAL, _executes(fails, []))
    kept = {name: float(str(value)) for name, (_, value) in found.changed.items()}
    assert kept.keys() == {"cell.parts.bolt.mass_kg", "parameters.speed"}
    assert len(str(kept["cell.parts.bolt.mass_kg"])) <= len("1.42")
    assert 0.97 < kept["parameters.speed"] <= 1.0
    assert len(str(kept["parameters.speed"])) <= len("0.98")


def test_several_numbers_move_together_first() -> None:
    def fails(values: Values) -> bool:
        return _number(values, "parameters.speed") + _number(values, "cell.parts.bolt.mass_kg") > 2.2

    found = shrink(_failing(FAR), FACTORS, NOMINAL, _executes(fails, []))
    assert {name: round(float(str(value)), 1) for name, (_, value) in found.changed.items()} == {
        "parameters.speed": 0.6,
        "cell.parts.bolt.mass_kg": 1.6,
    }


def test_progress_counts_every_run_and_names_what_is_left() -> None:
    seen: list[ShrinkProgress] = []
    runs: list[Configuration] = []
    fails = _executes(lambda v: _number(v, "cell.parts.bolt.mass_kg") > 1.4, runs)
    shrink(_failing(FAR), FACTORS, NOMINAL, fails, show=seen.append)
    assert [each.runs for each in seen] == list(range(1, len(runs) + 1))
    assert seen[-1].changed == ("cell.parts.bolt.mass_kg",)
    assert {each.step for each in seen} == {
        "seed and placement noise",
        "set back to nominal",
        "move towards nominal",
        "round",
    }


def test_integers_stay_integers() -> None:
    found = shrink(_failing(FAR), FACTORS, NOMINAL, _executes(lambda v: _number(v, "parameters.count") > 6, []))
    assert found.changed == {"parameters.count": (5, 7)}
    assert found.passes == {"parameters.count": 6}


def test_a_run_that_fails_otherwise_is_not_followed() -> None:
    def execute(configuration: Configuration) -> TrialResult:
        mass = _number(configuration.values, "cell.parts.bolt.mass_kg")
        outcome = "bad" if mass > 1.4 else "worse"
        return TrialResult(configuration=configuration, status="finished", outcome=outcome)

    found = shrink(_failing(FAR), FACTORS, NOMINAL, execute)
    assert found.result.outcome == "bad"
    assert list(found.changed) == ["cell.parts.bolt.mass_kg"]


def test_a_cause_is_the_same_with_other_numbers() -> None:
    first, other = (
        TrialResult(
            configuration=Configuration(number=0, seed=0, values={}),
            status="finished",
            outcome="bad",
            reason=f"the fingers stopped at {width} mm",
            reason_at=at,
        )
        for width, at in ((47.9, "left"), (3.2, "left"))
    )
    assert same_cause(first, other)
    assert not same_cause(first, msgspec.structs.replace(other, reason_at="right"))
    assert not same_cause(first, msgspec.structs.replace(other, reason="dropped"))
    assert not same_cause(first, msgspec.structs.replace(other, outcome="worse"))


def test_the_budget_ends_it_with_the_smallest_one_so_far() -> None:
    found = shrink(
        _failing(FAR),
        FACTORS,
        NOMINAL,
        _executes(lambda v: _number(v, "cell.parts.bolt.mass_kg") > 1.4, []),
        most_runs=3,
    )
    assert found.runs == 3
    assert not found.result.success


def test_an_interrupt_keeps_the_smallest_found_so_far() -> None:
    runs: list[Configuration] = []
    execute = _executes(lambda v: _number(v, "cell.parts.bolt.mass_kg") > 1.4, runs)

    def interrupted(configuration: Configuration) -> TrialResult:
        if len(runs) == 4:
            raise KeyboardInterrupt
        return execute(configuration)

    found = shrink(_failing(FAR), FACTORS, NOMINAL, interrupted)
    assert (found.interrupted, found.runs) == (True, 5)
    assert "cell.parts.bolt.mass_kg" in found.changed
    assert len(found.changed) < len(FAR)


def test_a_run_that_succeeds_is_refused() -> None:
    good = TrialResult(configuration=Configuration(number=2, seed=1, values={}), status="finished", success=True)
    with pytest.raises(ControlError, match="configuration 2 succeeds"):
        shrink(good, FACTORS, NOMINAL, _executes(lambda _values: True, []))


@given(
    st.fixed_dictionaries(
        {
            "parameters.speed": st.floats(0.0, 1.0),
            "displace.bolt.x_m": st.floats(-0.05, 0.05),
            "cell.parts.bolt.mass_kg": st.floats(0.0, 2.0),
            "faults": st.sampled_from(["none", "slip.yaml"]),
            "parameters.count": st.integers(1, 9),
        }
    ),
    st.floats(0.0, 3.0),
)
def test_what_is_found_fails_and_has_no_factor_that_could_be_set_back(values: Values, limit: float) -> None:
    def fails(tried: Values) -> bool:
        badness = _number(tried, "parameters.speed") + 20.0 * abs(_number(tried, "displace.bolt.x_m"))
        return badness + (tried["faults"] == "slip.yaml") > limit

    if not fails(values):
        return
    found = shrink(_failing(values), FACTORS, NOMINAL, _executes(fails, []))
    assert fails(found.result.configuration.values)
    for name, (nominal, _) in found.changed.items():
        assert not fails({**found.result.configuration.values, name: nominal})
