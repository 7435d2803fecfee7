"""Triggers see exactly the edges of their button, whatever the messages are."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from engine.errors import BusError
from engine.messages import GripperState, JointState, Message
from engine.skills.teaching import ButtonState
from engine.teaching import ButtonEdge, EdgeDetector


class Counter(Message, frozen=True, kw_only=True):
    count: int
    label: str = ""


@given(st.lists(st.booleans()))
def test_every_change_is_seen_once_and_nothing_else(values: list[bool]) -> None:
    detector = EdgeDetector(ButtonState, field="", value=True)
    seen = [detector.take(ButtonState(value=value)) for value in values]
    before = [False, *values][:-1] if values else []
    expected = [
        None if was == now else ButtonEdge.PRESSED if now else ButtonEdge.RELEASED
        for was, now in zip(before, values, strict=True)
    ]
    assert seen == expected
    assert detector.pressed == (values[-1] if values else False)


@given(st.lists(st.integers(min_value=-2, max_value=2)))
def test_a_number_is_compared_with_the_value(values: list[int]) -> None:
    detector = EdgeDetector(Counter, field="count", value=1)
    pressed = False
    for value in values:
        edge = detector.take(Counter(count=value))
        assert (edge is not None) == (pressed != (value == 1))
        pressed = value == 1


def test_one_is_not_true() -> None:
    detector = EdgeDetector(Counter, field="count", value=True)
    assert detector.take(Counter(count=1)) is None


def test_a_word_is_compared_with_the_value() -> None:
    detector = EdgeDetector(Counter, field="label", value="go")
    assert detector.take(Counter(count=0, label="go")) is ButtonEdge.PRESSED


def test_the_usual_field_is_found() -> None:
    state = GripperState(time_s=0.0, width_m=0.0, force_n=0.0, held=True)
    assert EdgeDetector(GripperState, field="", value=True).take(state) is ButtonEdge.PRESSED


def test_a_message_without_a_button_is_refused() -> None:
    with pytest.raises(BusError, match="0 boolean fields"):
        EdgeDetector(JointState, field="", value=True)


def test_an_unknown_field_is_refused_with_those_there_are() -> None:
    with pytest.raises(BusError, match="no field pressed") as refused:
        EdgeDetector(Counter, field="pressed", value=True)
    assert refused.value.hint == "it has count, label"
