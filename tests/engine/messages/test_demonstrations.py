"""Recorded motions accept what fits together and name the row that does not."""

from __future__ import annotations

from typing import Any

import msgspec
import pytest

from engine.errors import StoreError
from engine.messages.demonstrations import Trajectory
from engine.store import STANDARD_KINDS, verified_value

LED: dict[str, Any] = {
    "times_s": [0.0, 0.01],
    "joints": [[0.0, 1.0], [0.1, 1.1]],
    "names": ["a", "b"],
    "poses": [[0, 0, 0, 0, 0, 0, 1], [0, 0, 0.1, 0, 0, 0, 1]],
    "wrenches": [[0, 0, 1, 0, 0, 0], [0, 0, 2, 0, 0, 0]],
}


def test_a_recording_survives_being_stored() -> None:
    """With and without joints, poses and wrenches."""
    for left_out in ((), ("wrenches",), ("poses", "wrenches"), ("joints", "names")):
        fields = {name: value for name, value in LED.items() if name not in left_out}
        taken = verified_value(STANDARD_KINDS, "trajectory", fields, where="trajectory x")
        assert isinstance(taken, Trajectory)
        assert msgspec.convert(msgspec.json.decode(msgspec.json.encode(taken)), Trajectory) == taken


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ({"joints": [], "poses": []}, "give `joints`, `poses` or both"),
        ({"times_s": [0.0]}, "times_s"),
        ({"times_s": [0.0, 0.0]}, r"times_s\[1\] = 0.0 is not greater than 0.0"),
        ({"times_s": [0.0, 1.0, 2.0]}, "joints has 2 rows where times_s has 3"),
        ({"joints": [[0.0, 1.0], [0.1]]}, r"joints\[1\] has 1 values, not 2"),
        ({"names": ["a"]}, r"joints\[0\] has 2 values, not 1"),
        ({"poses": [[0, 0, 0], [0, 0, 0]]}, r"poses\[0\] has 3 values, not 7"),
        ({"poses": [[0, 0, 0, 0, 0, 0, 1], [0, 0, 0, 0, 0, 0, 0.5]]}, r"quaternion of poses\[1\] has length 0.5"),
        ({"wrenches": [[0] * 5] * 2}, r"wrenches\[0\] has 5 values, not 6"),
    ],
)
def test_a_recording_that_does_not_fit_together_is_refused(change: dict[str, object], words: str) -> None:
    with pytest.raises(StoreError, match=words):
        verified_value(STANDARD_KINDS, "trajectory", {**LED, **change}, where="trajectory x")


def test_numbers_that_are_not_finite_are_refused() -> None:
    with pytest.raises(msgspec.ValidationError, match=r"joints\[0\] has a non-finite number"):
        msgspec.convert({**LED, "joints": [[0.0, float("nan")], [0.0, 0.0]]}, Trajectory)
    with pytest.raises(msgspec.ValidationError, match="times_s"):
        msgspec.convert({**LED, "times_s": [0.0, float("inf")]}, Trajectory)
