"""Laws take over from one another without a step of the torque, in the time given, and within the limits."""

from __future__ import annotations

import numpy as np
import pytest

from robots.control.laws.torque_blend import TorqueBlend
from robots.port import Array

LIMIT = np.array([10.0, 10.0])
STEP_S = 0.001


def blended(blend: TorqueBlend, torque: Array, *, feedforward: float = 0.0) -> Array:
    """Return one period's torques."""
    return blend.after(torque, feedforward_nm=np.full(2, feedforward), step_s=STEP_S).copy()


def test_without_a_change_the_torques_pass_unaltered() -> None:
    blend = TorqueBlend(limit_nm=LIMIT)
    for value in (1.0, 5.0, -3.0):
        assert blended(blend, np.full(2, value)).tolist() == [value, value]


def test_a_change_fades_in_and_is_over_after_its_time() -> None:
    blend = TorqueBlend(limit_nm=LIMIT)
    torques = [blended(blend, np.array([1.0, 1.0]))]
    blend.start(duration_s=0.1)
    torques += [blended(blend, np.array([5.0, -5.0])) for _ in range(110)]
    assert np.abs(np.diff(np.array(torques), axis=0)).max() < 0.1
    assert torques[1] == pytest.approx([1.0, 1.0])
    assert torques[-1].tolist() == [5.0, -5.0]
    assert torques[98].tolist() != [5.0, -5.0]


def test_what_all_laws_have_in_common_is_not_held_back() -> None:
    blend = TorqueBlend(limit_nm=LIMIT)
    blended(blend, np.full(2, 3.0), feedforward=2.0)
    blend.start(duration_s=0.1)
    assert blended(blend, np.full(2, 6.0), feedforward=6.0) == pytest.approx([7.0, 7.0])


def test_the_first_law_of_all_and_one_after_a_restart_begin_at_once() -> None:
    blend = TorqueBlend(limit_nm=LIMIT)
    blend.start(duration_s=0.1)
    assert blended(blend, np.full(2, 4.0)).tolist() == [4.0, 4.0]
    blend.forget()
    blend.start(duration_s=0.1)
    assert blended(blend, np.full(2, -4.0)).tolist() == [-4.0, -4.0]


def test_the_sum_stays_within_the_limits() -> None:
    blend = TorqueBlend(limit_nm=LIMIT)
    blended(blend, np.full(2, 9.0), feedforward=-5.0)
    blend.start(duration_s=0.1)
    assert blended(blend, np.full(2, 9.0), feedforward=9.0).tolist() == [10.0, 10.0]
