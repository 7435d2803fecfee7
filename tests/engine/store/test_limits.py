"""What no database shall see is refused with the place inside the value."""

from __future__ import annotations

import math
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from engine.errors import StoreError
from engine.store.limits import MAX_BYTES, MAX_DEPTH, decode_value, encode_value
from tests.engine.json_values import JSON, TEXT


def nested(levels: int) -> dict[str, object]:
    """Make lists in lists."""
    value: list[object] = []
    for _ in range(levels):
        value = [value]
    return {"x": value}


@given(st.dictionaries(TEXT, JSON, max_size=5))
def test_any_object_within_the_limits_comes_back_equal(value: dict[str, object]) -> None:
    """Encoding and decoding are inverse."""
    assert decode_value(encode_value(value, where="record x"), where="record x") == value


@pytest.mark.parametrize("bad", [math.nan, math.inf, -math.inf])
def test_a_number_that_is_not_finite_is_named_by_its_place(bad: float) -> None:
    """JSON would turn it into null without a word."""
    with pytest.raises(StoreError, match=rf"record x: value\.a\[1\]\.b is {bad}, not a finite number"):
        encode_value({"a": [0, {"b": bad}]}, where="record x")


CIRCLE: list[Any] = []
CIRCLE.append(CIRCLE)


@pytest.mark.parametrize(
    ("value", "message"),
    [
        ({"n": 2**63}, r"value\.n is an integer beyond 64 bits"),
        ({"n": -(2**63) - 1}, r"value\.n is an integer beyond 64 bits"),
        ({"a": {1: 2}}, r"value\.a has the key 1, which is not text"),
        ({"o": object()}, "cannot be written as JSON"),
        ({"s": "\ud800"}, "cannot be written as JSON"),
        ({"circle": CIRCLE}, "cannot be written as JSON"),
        (nested(MAX_DEPTH), "deeper than 64 levels"),
        ([1], "must be an object with fields, not list"),
        ({"blob": "x" * MAX_BYTES}, r"takes 8\.4 MB, more than 8\.4 MB \(split it into several entries\)"),
    ],
    ids=["large", "small", "key", "object", "surrogate", "circle", "deep", "list", "size"],
)
def test_what_is_beyond_a_limit_is_refused(value: object, message: str) -> None:
    """Each limit has its own message."""
    with pytest.raises(StoreError, match=message):
        encode_value(value, where="record x")


def test_the_limits_themselves_are_allowed() -> None:
    """64-bit bounds and the deepest nesting pass."""
    value = nested(MAX_DEPTH - 1) | {"low": -(2**63), "high": 2**63 - 1}
    assert decode_value(encode_value(value, where="record x"), where="record x") == value
