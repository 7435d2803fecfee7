"""End effector frame and load, as libfranka takes them."""

from __future__ import annotations

import math

import numpy as np
import pytest

from robots.drivers.franka.franka_options import FrankaOptions
from robots.drivers.franka.franka_tool import end_effector_frame, total_load

# The frame of the Franka Hand as the web interface sets it: an eighth of a turn about z, 0.1034 m ahead; by columns.
EIGHTH = math.sqrt(0.5)
HAND = (EIGHTH, -EIGHTH, 0, 0, EIGHTH, EIGHTH, 0, 0, 0, 0, 1, 0, 0, 0, 0.1034, 1)


def matrix(columns: object) -> np.ndarray:
    return np.array(columns).reshape((4, 4), order="F")


def test_the_frame_has_the_given_centre_and_the_orientation_of_the_robot() -> None:
    frame = end_effector_frame(HAND, tcp_xyz_m=np.array((0.01, 0.02, 0.15)), options=FrankaOptions(host="x"))
    at_flange = matrix(HAND) @ matrix(frame)
    assert at_flange[:3, 3] == pytest.approx([0.01, 0.02, 0.15])
    assert at_flange[:3, :3] == pytest.approx(matrix(HAND)[:3, :3])


def test_the_option_gives_centre_and_orientation() -> None:
    options = FrankaOptions(host="x", tcp=(0.0, 0.0, 0.2, 0.0, 0.0, math.pi / 2))
    at_flange = matrix(HAND) @ matrix(end_effector_frame(HAND, tcp_xyz_m=np.zeros(3), options=options))
    expected = np.array(((0, -1, 0, 0), (1, 0, 0, 0), (0, 0, 1, 0.2), (0, 0, 0, 1)))
    assert at_flange == pytest.approx(expected, abs=1e-12)


def test_loads_add_up_at_their_common_centre_and_none_is_none() -> None:
    options = FrankaOptions(host="x", payload_kg=0.5, payload_com_m=(0.0, 0.0, 0.1))
    load = total_load(1.5, np.array((0.0, 0.04, 0.1)), options)
    assert load.mass_kg == 2.0
    assert load.com_m == pytest.approx((0.0, 0.03, 0.1))
    assert np.linalg.det(np.array(load.inertia_kg_m2).reshape(3, 3)) > 0.0
    none = total_load(0.0, np.zeros(3), FrankaOptions(host="x"))
    assert (none.mass_kg, set(none.inertia_kg_m2)) == (0.0, {0.0})
