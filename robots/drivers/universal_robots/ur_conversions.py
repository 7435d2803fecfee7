"""What controllers of Universal Robots measure and are told, in the terms of this project, and the reverse."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from robots.drivers.universal_robots.ur_options import UrOptions
from robots.port import Array

OUTPUTS = 10
_STANDARD_OUTPUTS = 8
_TOOL_OUTPUT_BIT = 16


def base_link_wrench(force: Sequence[float]) -> Array:
    """Return a wrench in the axes of the controller's base in those of `base_link`: half a turn about z."""
    x, y, z, rx, ry, rz = force
    return np.array((-x, -y, z, -rx, -ry, rz))


def digital_values(bits: int) -> tuple[bool, ...]:
    """Return 0 to 7, then those of the tool, from `actual_digital_output_bits` or `actual_digital_input_bits`."""
    numbers = (*range(_STANDARD_OUTPUTS), _TOOL_OUTPUT_BIT, _TOOL_OUTPUT_BIT + 1)
    return tuple(bool(bits >> number & 1) for number in numbers)


def output_program(output: int, *, on: bool) -> str:
    """Return a program that sets an output beside the main program."""
    kind, number = ("standard", output) if output < _STANDARD_OUTPUTS else ("tool", output - _STANDARD_OUTPUTS)
    return f"sec flexcell_output():\n  set_{kind}_digital_out({number}, {on})\nend\n"


def tool_centre(options: UrOptions, tcp_xyz_m: Array) -> list[float]:
    """Return the tool centre point at the flange; that of the options counts more."""
    return list(options.tcp or (*tcp_xyz_m.tolist(), 0.0, 0.0, 0.0))


def payload_with_load(options: UrOptions, load_kg: float, load_com_m: Array) -> tuple[float, list[float]]:
    """Return mass and centre of mass of tool and load together, at the flange."""
    mass_kg = options.payload_kg + load_kg
    if mass_kg <= 0.0:
        return 0.0, [0.0, 0.0, 0.0]
    tool_m = np.array(options.payload_com_m or (0.0, 0.0, 0.0))
    centre_m = (options.payload_kg * tool_m + load_kg * load_com_m) / mass_kg
    return mass_kg, centre_m.tolist()
