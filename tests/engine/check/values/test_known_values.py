"""A value is known as far as its expressions use nothing but what is known."""

from __future__ import annotations

import pytest

from engine.check.analyzed_behavior import template
from engine.check.values.known_values import UnknownValue, known_part


@pytest.mark.parametrize(
    ("value", "found"),
    [
        ("left", "left"),
        ("$${x}", "${x}"),
        ("${arm}", "left"),
        ("${arm + '_home'}", "left_home"),
        ("${part}", UnknownValue("part")),
        ("${part + '1'}", UnknownValue()),
        ("a ${part}", UnknownValue()),
        ("${1 / 0}", UnknownValue()),
        ("${", UnknownValue()),
        ({"robot": "${arm}", "at": [1, "${part}"]}, {"robot": "left", "at": [1, UnknownValue("part")]}),
    ],
)
def test_what_is_known_of_a_value(value: object, found: object) -> None:
    """Of an expression that is nothing but a name, that name."""
    assert known_part(template(value), {"arm": "left"}) == found
