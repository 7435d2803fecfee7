"""A value is known as far as its expressions use nothing but what is known."""

from __future__ import annotations

import pytest

from engine.check.settled import Open, settled
from engine.check.subject import template


@pytest.mark.parametrize(
    ("value", "found"),
    [
        ("left", "left"),
        ("$${x}", "${x}"),
        ("${arm}", "left"),
        ("${arm + '_home'}", "left_home"),
        ("${part}", Open("part")),
        ("${part + '1'}", Open()),
        ("a ${part}", Open()),
        ("${1 / 0}", Open()),
        ("${", Open()),
        ({"robot": "${arm}", "at": [1, "${part}"]}, {"robot": "left", "at": [1, Open("part")]}),
    ],
)
def test_what_is_known_of_a_value(value: object, found: object) -> None:
    """Of an expression that is nothing but a name, that name."""
    assert settled(template(value), {"arm": "left"}) == found
