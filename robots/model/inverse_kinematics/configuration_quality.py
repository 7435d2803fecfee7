"""The quality of a configuration: distance to a singularity, its kind, and the tool motion it impedes."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from robots.model.inverse_kinematics.chain import KinematicChain
from robots.model.inverse_kinematics.ideal_arm import IdealArm, meeting_point
from robots.port import Array

SINGULAR = 0.03
"""Below this smallest singular value (metres and radians weighted equally) an arm counts as singular."""

_PARALLEL = 1e-6
_SAME_POINT_M = 1e-6


@dataclass(frozen=True, kw_only=True)
class ConfigurationQuality:
    """The quality of one configuration.

    `dexterity` is the smallest singular value of the Jacobian: some unit tool motion needs 1/dexterity of
    joint motion. `manipulability` is the product of all singular values (Yoshikawa). `kind` is `wrist`,
    `elbow` or `shoulder` where a six-axis arm of a known family is singular, otherwise empty. `hardest`
    (6,) is the unit tool motion (m/s, then rad/s, world axes) that requires the most joint motion.
    """

    dexterity: float
    manipulability: float
    kind: str
    hardest: Array

    @property
    def singular(self) -> bool:
        """Whether the arm is at or near a singularity."""
        return self.dexterity < SINGULAR

    @property
    def words(self) -> str:
        """Description for messages; empty away from singularities."""
        if not self.singular:
            return ""
        what = f"its {self.kind} singularity" if self.kind else "a singularity"
        return f"near {what} (dexterity {self.dexterity:.3f}): the tool can hardly {_motion(self.hardest)}"


def evaluate_configuration(jacobian: Array, kind: str) -> ConfigurationQuality:
    """Return the quality of a configuration with this Jacobian (6, n)."""
    directions, values, _ = np.linalg.svd(jacobian)
    hardest = directions[:, len(values) - 1]
    # The sign of a singular vector is arbitrary: the largest entry is made positive, for reproducible results.
    hardest = hardest * np.sign(hardest[int(np.argmax(np.abs(hardest)))])
    return ConfigurationQuality(
        dexterity=float(values[-1]),
        manipulability=float(np.prod(values)),
        kind=kind if float(values[-1]) < SINGULAR else "",
        hardest=hardest,
    )


def kind_of_singularity(chain: KinematicChain, ideal: IdealArm, axes: Array, points: Array) -> str:
    """Return the singularity that a six-axis arm is near; empty for arms of unknown families.

    `axes` and `points` (6, 3) are its joint lines in the configuration.
    """
    if chain.dof != 6 or chain.sliding.any() or not _parallel(ideal, 1, 2):
        return ""
    if _parallel(ideal, 2, 3):
        return _smallest(_three_parallel(axes, points))
    if _wrist_meets(ideal):
        return _smallest(_spherical_wrist(axes, points))
    return ""


def _three_parallel(axes: Array, points: Array) -> dict[str, float]:
    """Return measures, 0 at the singularity, of an arm whose axes 2, 3, 4 are parallel (Universal Robots)."""
    normal, upper_arm_m = _normal_of_arm(axes, points)
    centre = _meeting(axes, points, 4, 5)
    side = np.cross(axes[0], axes[1])
    return {
        "wrist": float(np.linalg.norm(np.cross(axes[3], axes[5]))),
        "elbow": abs(float(normal @ (points[3] - points[1]))) / upper_arm_m,
        "shoulder": abs(float(side @ (centre - points[0]))) / upper_arm_m,
    }


def _spherical_wrist(axes: Array, points: Array) -> dict[str, float]:
    """Return measures, 0 at a singularity, of an arm with parallel axes 2, 3 and a spherical wrist (ABB and others)."""
    normal, upper_arm_m = _normal_of_arm(axes, points)
    centre = _meeting(axes, points, 4, 5)
    away = centre - points[0]
    return {
        "wrist": float(np.linalg.norm(np.cross(axes[3], axes[5]))),
        "elbow": abs(float(normal @ (centre - points[1]))) / upper_arm_m,
        "shoulder": float(np.linalg.norm(away - axes[0] * (axes[0] @ away))) / upper_arm_m,
    }


def _normal_of_arm(axes: Array, points: Array) -> tuple[Array, float]:
    """Return the direction normal to the plane of axes 2 and 3, and their distance."""
    along = points[2] - points[1]
    along = along - axes[1] * (axes[1] @ along)
    length = float(np.linalg.norm(along))
    return np.asarray(np.cross(axes[1], along / length), dtype=np.float64), length


def _meeting(axes: Array, points: Array, i: int, j: int) -> Array:
    point = meeting_point(axes, points, i, j)
    return points[i] if point is None else point


def _parallel(ideal: IdealArm, i: int, j: int) -> bool:
    return float(np.linalg.norm(np.cross(ideal.axes[i], ideal.axes[j]))) < _PARALLEL


def _wrist_meets(ideal: IdealArm) -> bool:
    first = meeting_point(ideal.axes, ideal.points, 4, 3)
    second = meeting_point(ideal.axes, ideal.points, 4, 5)
    return first is not None and second is not None and float(np.linalg.norm(first - second)) < _SAME_POINT_M


def _smallest(measures: dict[str, float]) -> str:
    return min(measures, key=lambda kind: measures[kind])


def _motion(direction: Array) -> str:
    """Return a tool motion in words, by its larger part."""
    moving, turning = direction[:3], direction[3:]
    words, vector = (
        ("move along", moving) if np.linalg.norm(moving) >= np.linalg.norm(turning) else ("turn about", turning)
    )
    x, y, z = (vector / np.linalg.norm(vector)).tolist()
    return f"{words} ({x:.2f}, {y:.2f}, {z:.2f})"
