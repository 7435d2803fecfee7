"""The phase of a movement primitive and the Gaussian kernels over it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from robots.port import Array

# Width of a kernel as a share of the distance to the next one, as in the Jožef Stefan Institute's library.
_OVERLAP = 0.75


def phase_at(share: Array, a_x: float) -> Array:
    """Return the phase x after `share` of the duration tau (any shape): 1 at the start, falling exponentially.

    The solution of the canonical system tau ẋ = -a_x x (Ijspeert et al. 2013, equation 2.2).
    """
    return np.exp(-a_x * np.asarray(share, dtype=np.float64))


@dataclass(frozen=True, kw_only=True)
class GaussianKernels:
    """N Gaussian kernels: centres `c` and variances `sigma` over the phase, shape (N,)."""

    c: Array
    sigma: Array

    @classmethod
    def of(cls, c: Sequence[float], sigma: Sequence[float]) -> GaussianKernels:
        """Return the kernels of stored parameters."""
        return cls(c=np.array(c, dtype=np.float64), sigma=np.array(sigma, dtype=np.float64))

    @classmethod
    def evenly(cls, number: int, *, a_x: float) -> GaussianKernels:
        """Return kernels at even times from the start to tau."""
        if number == 1:
            return cls(c=np.exp([-a_x / 2.0]), sigma=np.ones(1))
        c = np.exp(-a_x * np.linspace(0.0, 1.0, number))
        sigma = (_OVERLAP * np.diff(c)) ** 2
        return cls(c=c, sigma=np.append(sigma, sigma[-1]))

    def at(self, phase: Array) -> Array:
        """Return the activations at each phase, (T, N), normalised to the sum 1.

        Far from all kernels only the nearest one is active, which avoids 0 / 0.
        """
        exponents = -((np.asarray(phase)[:, None] - self.c) ** 2) / (2.0 * self.sigma)
        activations = np.exp(exponents - exponents.max(axis=1, keepdims=True))
        return activations / activations.sum(axis=1, keepdims=True)
