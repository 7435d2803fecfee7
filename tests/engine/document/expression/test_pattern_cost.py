"""The weight of a pattern grows with what its automaton holds."""

from __future__ import annotations

import pytest

from engine.document.expression.pattern_cost import pattern_weight


@pytest.mark.parametrize(
    ("pattern", "least"),
    [
        ("a{900}", 900),
        ("(a{30}){30}", 900),
        ("((a{10}b){10}c){10}", 1_000),
        (".{900}", 10_000),
        ("\\pL{100}", 100_000),
        ("[a\\pL]", 5_000),
        ("(?i)[a-z]{100}", 2_000),
    ],
)
def test_repetition_and_classes_multiply(pattern: str, least: float) -> None:
    """Nested counts too."""
    assert pattern_weight(pattern) >= least


@pytest.mark.parametrize(
    "pattern", ["^[a-z]+_[0-9]{1,4}$", "part.*", "(left|right)_arm", "", "(((", ")", "[", "\\", "{3}"]
)
def test_ordinary_and_broken_patterns_weigh_little(pattern: str) -> None:
    """Whether it is valid is for the evaluator to say."""
    assert pattern_weight(pattern) < 500
