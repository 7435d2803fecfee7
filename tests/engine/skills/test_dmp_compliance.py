"""The compliance of a path is checked where it is made, whoever makes it."""

from __future__ import annotations

import pytest

from engine.messages import Vector6
from engine.skills.dmp import Compliance

ZEROS: Vector6 = (0.0, 0.0, 0.0, 0.0, 0.0, 0.0)


def test_an_axis_is_active_by_a_share() -> None:
    with pytest.raises(ValueError, match="`active` is from 0 to 1"):
        Compliance(active=(0.0, 2.0, 0.0, 0.0, 0.0, 0.0))


def test_damping_is_above_zero() -> None:
    with pytest.raises(ValueError, match="`damping` is above 0"):
        Compliance(damping=ZEROS)
