"""The kernels of a primitive lie evenly in time, and their sum is 1 at every phase."""

from __future__ import annotations

import numpy as np
import pytest

from robots.motion.dmp.kernels import GaussianKernels, phase_at


@pytest.mark.parametrize(("number", "shares"), [(1, [0.5]), (2, [0.0, 1.0]), (5, [0.0, 0.25, 0.5, 0.75, 1.0])])
def test_kernels_lie_evenly_in_time(number: int, shares: list[float]) -> None:
    """A single one in the middle."""
    kernels = GaussianKernels.evenly(number, a_x=2.0)
    assert kernels.c == pytest.approx(phase_at(np.array(shares), 2.0))
    assert kernels.sigma.shape == (number,)
    assert kernels.sigma.min() > 0.0


def test_a_kernel_is_as_wide_as_three_quarters_of_the_way_to_the_next() -> None:
    kernels = GaussianKernels.evenly(3, a_x=2.0)
    apart = np.diff(kernels.c)
    assert np.sqrt(kernels.sigma) == pytest.approx(0.75 * np.abs([apart[0], apart[1], apart[1]]))


def test_activations_sum_to_one_also_far_from_every_kernel() -> None:
    kernels = GaussianKernels.of([1.0, 0.3], [0.01, 0.01])
    activations = kernels.at(np.array([1.0, 0.65, 0.3, -40.0]))
    assert activations.sum(axis=1) == pytest.approx(np.ones(4))
    assert activations[1] == pytest.approx([0.5, 0.5])
    assert activations[3] == pytest.approx([0.0, 1.0])
    apart = np.exp(-(0.7**2) / 0.02)
    assert activations[0] == pytest.approx([1.0 / (1.0 + apart), apart / (1.0 + apart)])
