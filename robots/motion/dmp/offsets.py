"""Values over the phase as kernel sums: learned offsets and target forces, evaluated and fitted (RCL table 8).

Learning is iterative (Gams et al. 2014): a pass adds the offsets of the previous passes and records the
total offset of force control; the next pass adds that record, smoothed by the kernels. So the force error
decreases from pass to pass.
"""

from __future__ import annotations

import numpy as np

from engine.errors import RobotError
from engine.messages.primitives import CartOffsets, ForceReference
from robots.motion.dmp.kernels import GaussianKernels
from robots.port import Array

OFFSET_KERNELS = 50
"""Default number of kernels for offsets."""

# Regularisation that keeps the weights of kernels without nearby samples, relative to the weight of one sample.
_KEEP = 1e-3


def offsets_at(offsets: CartOffsets, phase: Array) -> Array:
    """Return the offsets at each phase: metres and rotation vector, (T, 6)."""
    return _sum(GaussianKernels.of(offsets.c_o, offsets.sigma_o), np.array(offsets.weights), phase)


def wrench_at(force: ForceReference, phase: Array) -> Array:
    """Return the target force (N) and torque (Nm) at each phase, (T, 6)."""
    return _sum(GaussianKernels.of(force.c_f, force.sigma_f), np.array(force.weights), phase)


def no_offsets(kernels: int = OFFSET_KERNELS, *, a_x: float) -> CartOffsets:
    """Return zero offsets with `kernels` kernels, evenly over a primitive's duration."""
    return _offsets(GaussianKernels.evenly(kernels, a_x=a_x), np.zeros((6, kernels)))


def offsets_from_samples(phase: Array, added: Array, *, given: CartOffsets, share: float = 1.0) -> CartOffsets:
    """Return the offsets for the next pass: those of this pass plus the added deviations.

    Args:
        phase: The phase at each sample, (T,), decreasing.
        added: Deviation of the motion beyond the given offsets: metres and rotation vector, (T, 6).
        given: Offsets of this pass; their kernels are reused.
        share: Learned share of the deviation, 0 to 1; below 1 noise averages out over the passes.

    Raises:
        RobotError: the shapes do not match, a value is not finite, or there are no samples.
    """
    if phase.ndim != 1 or added.shape != (len(phase), 6) or len(phase) == 0:
        raise RobotError(
            f"phases {phase.shape} and offsets {added.shape} are not a record",
            hint="give one row of six for each phase",
        )
    if not (np.isfinite(phase).all() and np.isfinite(added).all()):
        raise RobotError("the recorded offsets have values that are not finite")
    kernels = GaussianKernels.of(given.c_o, given.sigma_o)
    activations = kernels.at(phase)
    normal = activations.T @ activations + _KEEP * np.eye(len(kernels.c))
    learned: Array = np.linalg.solve(normal, activations.T @ added).astype(np.float64)
    return _offsets(kernels, np.array(given.weights) + share * learned.T)


def _sum(kernels: GaussianKernels, weights: Array, phase: Array) -> Array:
    return kernels.at(np.atleast_1d(phase)) @ weights.T


def _offsets(kernels: GaussianKernels, weights: Array) -> CartOffsets:
    w1o, w2o, w3o, w4o, w5o, w6o = (tuple(row) for row in weights.tolist())
    return CartOffsets(
        c_o=tuple(kernels.c.tolist()), sigma_o=tuple(kernels.sigma.tolist()),
        w1o=w1o, w2o=w2o, w3o=w3o, w4o=w4o, w5o=w5o, w6o=w6o,
    )  # fmt: skip
