"""Maps the joints of a robot's URDF to the angles of its controller, and back."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from robots.port import Array


@dataclass(frozen=True, kw_only=True)
class JointMap:
    """device = `matrix` · model + `offset_rad`: rows of n factors, n offsets; linear, so rates map by the matrix.

    An ABB controller measures its third axis against the horizontal (joint 2 is added); a hobby
    servo has a different zero. Most arms have the identity. `lower_rad` and `upper_rad` are the
    controller's additional ranges of its own angles; infinite for none.
    """

    matrix: tuple[tuple[float, ...], ...]
    offset_rad: tuple[float, ...]
    lower_rad: tuple[float, ...]
    upper_rad: tuple[float, ...]

    @classmethod
    def identity(cls, dof: int) -> JointMap:
        """Return the map of a robot whose controller uses the joints of the URDF."""
        return cls(
            matrix=tuple(tuple(row) for row in np.eye(dof).tolist()),
            offset_rad=(0.0,) * dof,
            lower_rad=(-np.inf,) * dof,
            upper_rad=(np.inf,) * dof,
        )

    @property
    def is_identity(self) -> bool:
        """True when both angles are the same."""
        same = JointMap.identity(len(self.offset_rad))
        return (self.matrix, self.offset_rad) == (same.matrix, same.offset_rad)

    def to_device(self, joints: Array) -> Array:
        """Return the controller's angles for joints of shape (..., n)."""
        return joints @ np.array(self.matrix).T + np.array(self.offset_rad)

    def to_model(self, device: Array) -> Array:
        """Return the joints of the URDF for the controller's angles, shape (..., n)."""
        return (device - np.array(self.offset_rad)) @ np.linalg.inv(np.array(self.matrix)).T

    def rates_to_device(self, rates: Array) -> Array:
        """Return the controller's rates for joint rates of shape (..., n)."""
        return rates @ np.array(self.matrix).T

    def efforts_to_device(self, efforts: Array) -> Array:
        """Return the torques at the controller's axes for joint torques of shape (..., n), at equal power."""
        return efforts @ np.linalg.inv(np.array(self.matrix))

    def words(self, joint: int, names: tuple[str, ...]) -> str:
        """Return the formula of the controller's angle of a joint, `joint_3 + joint_2`."""
        factors = [(names[other], factor) for other, factor in enumerate(self.matrix[joint]) if other != joint]
        sums = [_term(name, factor) for name, factor in factors if factor != 0.0]
        return " ".join((names[joint], *sums))


def _term(name: str, factor: float) -> str:
    share = "" if abs(factor) == 1.0 else f"{abs(factor):g} "
    return f"{'+' if factor > 0.0 else '-'} {share}{name}"
