"""Durations: what is a duration, and how many seconds it has."""

from __future__ import annotations

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from engine.document.duration import seconds
from engine.errors import DocumentError


@pytest.mark.parametrize(
    ("text", "value"),
    [
        ("30 s", 30.0),
        ("500 ms", 0.5),
        ("2 min", 120.0),
        ("1 h", 3600.0),
        ("1.5s", 1.5),
        (2, 2.0),
        (0.25, 0.25),
        (0, 0.0),
    ],
)
def test_a_duration_has_seconds(text: float | str, value: float) -> None:
    """Numbers are seconds, text has a unit."""
    assert seconds(text) == value


@pytest.mark.parametrize(
    "text", ["", "30", "s", "-3 s", "3 sec", "3  s", "1e3 s", " 3 s", "3 s ", -1, -0.1, math.inf, math.nan]
)
def test_what_is_no_duration_is_refused(text: float | str) -> None:
    """Negative, endless, without unit or with an unknown one."""
    with pytest.raises(DocumentError, match="is not a duration"):
        seconds(text)


@given(
    st.integers(0, 10**5),
    st.sampled_from([("ms", 0.001), ("s", 1.0), ("min", 60.0), ("h", 3600.0)]),
    st.sampled_from(["", " "]),
)
def test_every_unit_scales(amount: int, unit: tuple[str, float], gap: str) -> None:
    """Amount times unit."""
    assert seconds(f"{amount}{gap}{unit[0]}") == amount * unit[1]
