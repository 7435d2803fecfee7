"""The limits of the arms are those of their makers' data sheets, here in the units and the order of the sheets."""

from __future__ import annotations

import math

import pytest

from robots.model.registry import robot_model

AXES = {
    # ABB, product specification IRB 4600, variant 60/2.05: working range and speed of axes 1 to 6.
    "irb4600": (
        (-180, 180, 175),
        (-90, 150, 175),
        (-180, 75, 175),
        (-400, 400, 250),
        (-125, 120, 250),
        (-400, 400, 360),
    ),
    # Universal Robots, UR10: base and shoulder 120°/s, others 180°/s; the elbow's range is that of the URDF.
    "ur10": ((-360, 360, 120), (-360, 360, 120), (-180, 180, 180), *(((-360, 360, 180),) * 3)),
}


@pytest.mark.parametrize("name", AXES)
def test_ranges_and_speeds_are_those_of_the_data_sheet(name: str) -> None:
    limits = robot_model(name).limits
    found = [
        tuple(round(math.degrees(value), 3) for value in axis)
        for axis in zip(limits.lower_rad, limits.upper_rad, limits.velocity_rad_s, strict=True)
    ]
    assert found == [tuple(map(float, axis)) for axis in AXES[name]]
