"""Sizes hold for every value they were taken from, and large or strange values are refused early."""

from __future__ import annotations

from typing import cast

import pytest
from hypothesis import given
from hypothesis import strategies as st

from engine.document.expression.value_size import (
    MAX_WEIGHT,
    SCALAR,
    ValueSize,
    either_size,
    joined_size,
    measure_value,
    text_size,
)
from engine.errors import ExpressionError
from engine.messages import Pose

plain = st.recursive(
    st.none() | st.booleans() | st.integers() | st.text(max_size=300),
    lambda inside: st.lists(inside, max_size=5) | st.dictionaries(st.text(max_size=5), inside, max_size=5),
    max_leaves=20,
)


def keeps_to(value: object, size: ValueSize) -> bool:
    """Tell whether a value is within a size, everywhere inside too."""
    if isinstance(value, str):
        return len(value) <= size.text
    if isinstance(value, list | dict):
        whole = cast("list[object] | dict[str, object]", value)
        items = list(whole) if isinstance(whole, list) else [*whole.keys(), *whole.values()]
        return len(whole) <= size.length and all(keeps_to(item, size.inside) for item in items)
    return True


@given(one=plain, other=plain)
def test_values_keep_to_their_sizes_alone_and_together(one: object, other: object) -> None:
    """Also to the size of either of them."""
    sizes = measure_value(one, name="one"), measure_value(other, name="other")
    assert keeps_to(one, sizes[0])
    assert keeps_to(one, either_size(*sizes))
    assert keeps_to(other, either_size(*sizes))
    if isinstance(one, list) and isinstance(other, list):
        assert keeps_to([*cast("list[object]", one), *cast("list[object]", other)], joined_size(*sizes))


def test_weight_counts_values_and_text() -> None:
    """A text of 100 characters weighs one more than a number."""
    assert measure_value(3, name="x") == SCALAR
    assert measure_value("a" * 100, name="x").weight == text_size(100).weight == 2
    assert measure_value([1, [2, 3], {"k": 4}], name="x").weight == pytest.approx(8, abs=0.1)
    assert measure_value(Pose(xyz=(1.0, 2.0, 3.0)), name="x").weight < 30


@pytest.mark.parametrize(
    ("value", "says"),
    [
        ([0] * (MAX_WEIGHT + 1), "contains more than"),
        ([[0] * 1_000] * 1_000, "contains more than"),
        ("x" * 100 * MAX_WEIGHT, "contains more than"),
        (object(), "not a document value"),
        ([object()], "not a document value"),
    ],
)
def test_what_is_too_large_or_no_value_of_a_document_is_refused(value: object, says: str) -> None:
    """The message names the variable."""
    with pytest.raises(ExpressionError, match=says) as refusal:
        measure_value(value, name="image")
    assert "`image`" in str(refusal.value)


def test_a_list_that_holds_itself_is_refused() -> None:
    """The walk ends."""
    value: list[object] = []
    value.append(value)
    with pytest.raises(ExpressionError, match="nested"):
        measure_value(value, name="x")
