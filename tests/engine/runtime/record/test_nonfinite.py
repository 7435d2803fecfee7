"""NaN and infinity in requests, answers and messages come back from events as they were."""

from __future__ import annotations

import math
from typing import cast

from hypothesis import given
from hypothesis import strategies as st

from engine.event import MessageReceived
from engine.journal import decode_event, encode_event
from engine.runtime.record.nonfinite import decode_nonfinite, encode_nonfinite

PLAIN = st.recursive(
    st.none() | st.booleans() | st.integers(-5, 5) | st.floats() | st.text(max_size=3),
    lambda inside: st.lists(inside, max_size=3) | st.dictionaries(st.text(max_size=3), inside, max_size=3),
    max_leaves=12,
)


def _same(one: object, other: object) -> bool:
    if isinstance(one, float) and isinstance(other, float):
        return one == other or (math.isnan(one) and math.isnan(other))
    if isinstance(one, dict) and isinstance(other, dict):
        known, told = cast("dict[str, object]", one), cast("dict[str, object]", other)
        return known.keys() == told.keys() and all(_same(known[key], told[key]) for key in known)
    if isinstance(one, list) and isinstance(other, list):
        these, those = cast("list[object]", one), cast("list[object]", other)
        return len(these) == len(those) and all(map(_same, these, those))
    return one == other


@given(PLAIN)
def test_whatever_a_message_holds_comes_back_from_its_event(message: object) -> None:
    """By way of JSON."""
    event = MessageReceived(seq=1, time_s=0.0, path="root", topic="t", message=encode_nonfinite(message))
    told = decode_event(encode_event(event))
    assert isinstance(told, MessageReceived)
    assert _same(decode_nonfinite(told.message), message)


def test_what_holds_none_is_not_copied() -> None:
    """Messages may be long."""
    message = {"a": [1.0, {"b": 2.0}]}
    assert encode_nonfinite(message) is message
