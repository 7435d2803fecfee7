"""Factors of the command line."""

from __future__ import annotations

import pytest

from engine.errors import DocumentError
from engine.sweep.design.factor_text import parse_factor


@pytest.mark.parametrize(
    ("text", "address", "factor"),
    [
        ("speed=0.3..1.0", "parameters.speed", {"uniform": [0.3, 1.0]}),
        ("count=1..9", "parameters.count", {"uniform": [1.0, 9.0], "integer": True}),
        ("count=1..9.0", "parameters.count", {"uniform": [1.0, 9.0]}),
        ("inputs.a=-1e-3..1e3", "inputs.a", {"uniform": [-0.001, 1000.0]}),
        ("displace.bolt.x_m=normal(0, 0.004)", "displace.bolt.x_m", {"normal": {"mean": 0.0, "deviation": 0.004}}),
        ("cell.parts.bolt.mass_kg=log(0.05..0.5)", "cell.parts.bolt.mass_kg", {"log_uniform": [0.05, 0.5]}),
        ("faults=none,slip.yaml", "faults", {"values": ["none", "slip.yaml"]}),
        ("seed=1, 2,3", "seed", {"values": [1, 2, 3]}),
        ('parameters.mode=fast,"slow",true,2.5', "parameters.mode", {"values": ["fast", "slow", True, 2.5]}),
    ],
)
def test_each_form(text: str, address: str, factor: dict[str, object]) -> None:
    assert parse_factor(text) == (address, factor)


@pytest.mark.parametrize("text", ["speed", "=1..2", "speed=", "", "speed= "])
def test_what_is_no_factor_is_refused_with_the_forms(text: str) -> None:
    with pytest.raises(DocumentError, match=r"is not a factor \(NAME=0.3..1.0"):
        parse_factor(text)
