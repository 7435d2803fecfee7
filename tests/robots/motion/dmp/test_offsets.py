"""Offsets and forces over the phase: what was recorded comes back, and passes add up."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from engine.errors import RobotError
from engine.messages.primitives import ForceReference
from robots.motion.dmp import no_offsets, offsets_at, offsets_from_samples, phase_at, wrench_at
from robots.port import Array
from tests.robots.motion.dmp.demonstrations import seeds

A_X = 2.0
SHARES = np.linspace(0.0, 1.0, 301)
PHASE = phase_at(SHARES, A_X)


def surface(seed: int) -> Array:
    """A smooth unevenness over the way, (T, 6), millimetres and milliradians in size."""
    random = np.random.default_rng(seed)
    waves = np.sin(np.outer(SHARES, np.arange(1, 6)) * np.pi + random.uniform(0.0, 6.0, 5))
    return np.asarray(waves @ (0.004 * random.normal(size=(5, 6))), dtype=np.float64)


@settings(max_examples=20, deadline=None)
@given(seeds)
def test_recorded_offsets_come_back_over_the_phase(seed: int) -> None:
    """Within two percent of their size."""
    wanted = surface(seed)
    learned = offsets_from_samples(PHASE, wanted, given=no_offsets(a_x=A_X))
    assert np.abs(offsets_at(learned, PHASE) - wanted).max() < 0.02 * np.abs(wanted).max()


@settings(max_examples=10, deadline=None)
@given(seeds, st.floats(0.3, 0.9), st.floats(0.0, 2e-4))
def test_each_pass_starts_where_the_last_one_ended(seed: int, followed: float, noise_m: float) -> None:
    """A control that makes up only a share of what is missing in one pass leaves less in each: iterative learning."""
    wanted, random = surface(seed), np.random.default_rng(seed)
    offsets = no_offsets(a_x=A_X)
    missing: list[float] = []
    for _ in range(4):
        left = wanted - offsets_at(offsets, PHASE)
        missing.append(float(np.sqrt((left**2).mean())))
        added = followed * left + noise_m * random.normal(size=left.shape)
        offsets = offsets_from_samples(PHASE, added, given=offsets)
    assert missing[1] < (1.05 - followed) * missing[0] + noise_m
    assert missing[3] <= missing[1] + noise_m
    assert missing[3] < max((1.1 - followed) ** 3 * missing[0], 2.0 * noise_m) + 1e-5


def test_where_nothing_was_recorded_the_offsets_stay_what_they_were() -> None:
    """A pass that was recorded in its second half only leaves the first half alone."""
    before = offsets_from_samples(PHASE, np.full((len(PHASE), 6), 0.003), given=no_offsets(a_x=A_X))
    late = SHARES > 0.5
    after = offsets_from_samples(PHASE[late], np.full((late.sum(), 6), 0.002), given=before)
    values = offsets_at(after, PHASE)[:, 0]
    assert values[SHARES < 0.4] == pytest.approx(0.003, abs=2e-4)
    assert values[SHARES > 0.6] == pytest.approx(0.005, abs=2e-4)


def test_a_share_of_what_was_added_can_be_learned() -> None:
    """Half of it averages noise over the passes."""
    learned = offsets_from_samples(PHASE, np.full((len(PHASE), 6), 0.004), given=no_offsets(a_x=A_X), share=0.5)
    assert offsets_at(learned, PHASE) == pytest.approx(0.002, abs=1e-5)


def test_a_constant_force_is_the_same_at_every_phase() -> None:
    """The short way to ask for it."""
    force = ForceReference.constant(force_n=(0.0, 0.0, 10.0), torque_nm=(0.0, 0.5, 0.0))
    assert wrench_at(force, PHASE) == pytest.approx(np.tile([0.0, 0.0, 10.0, 0.0, 0.5, 0.0], (len(PHASE), 1)))


@pytest.mark.parametrize(
    ("phase", "added", "words"),
    [
        (PHASE, np.zeros((3, 6)), "are not a record"),
        (np.zeros(0), np.zeros((0, 6)), "are not a record"),
        (PHASE, np.full((len(PHASE), 6), np.nan), "not finite"),
    ],
)
def test_a_record_that_makes_no_sense_is_refused(phase: Array, added: Array, words: str) -> None:
    with pytest.raises(RobotError, match=words):
        offsets_from_samples(phase, added, given=no_offsets(a_x=A_X))
