"""The parameters of an arm for fast kinematics, derived only from its forward kinematics."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from engine.errors import CellError
from robots.model.mechanics.kinematics import ArmKinematics
from robots.model.transform import RigidTransform
from robots.port import Array

# Required agreement of the chain with its source kinematics, metres and entries of the rotation.
_AGREEMENT = 1e-9


@dataclass(frozen=True, kw_only=True)
class KinematicChain:
    """A serial arm whose joints rotate about, or slide along, the z axis of their frames.

    `placements` (n + 1, 3, 4): the pose of each joint's frame in the previous one with all joints at 0,
    from the world to the tool. `sliding` (n,) marks prismatic joints. `bounds` (3, n): lower limits,
    upper limits, speeds. `axes` and `points` (n, 3) are the joint lines in the world at 0, `tool`
    (3, 4) the tool's pose there.
    """

    placements: Array
    sliding: NDArray[np.bool_]
    bounds: Array
    axes: Array
    points: Array
    tool: Array

    @property
    def dof(self) -> int:
        """Number of joints n."""
        return len(self.sliding)


def chain_of(kinematics: ArmKinematics) -> KinematicChain:
    """Return the chain of an arm at its base pose in the cell.

    A column of the Jacobian with all joints at 0 is a joint line: its direction, and its moment about
    the tool. The lines and the tool's pose at 0 determine the arm.

    Raises:
        CellError: the arm is not a serial chain of single joints.
    """
    pose, jacobian = kinematics.tool_pose_and_jacobian(np.zeros(kinematics.dof))
    tool = matrix_of(pose)
    turning = np.linalg.norm(jacobian[3:], axis=0) > 0.5
    axes = np.where(turning, jacobian[3:], jacobian[:3]).T.copy()
    axes /= np.linalg.norm(axes, axis=1, keepdims=True)
    offsets = np.cross(jacobian[3:].T, jacobian[:3].T) * turning[:, None]
    points = pose.xyz + offsets
    limits = kinematics.limits
    chain = KinematicChain(
        placements=_placements(axes, points, tool),
        sliding=~turning,
        bounds=np.array([limits.lower_rad, limits.upper_rad, limits.velocity_rad_s]),
        axes=axes,
        points=points,
        tool=tool,
    )
    _check(chain, kinematics)
    return chain


def matrix_of(pose: RigidTransform) -> Array:
    """Return a pose as rotation and position side by side, shape (3, 4)."""
    matrix = np.empty((3, 4))
    matrix[:, :3] = pose.rotation
    matrix[:, 3] = pose.xyz
    return matrix


def tool_at(chain: KinematicChain, joints: Array) -> Array:
    """Return the tool's pose (3, 4) in the world, by numpy alone."""
    rotation, position = np.eye(3), np.zeros(3)
    for placement, sliding, joint in zip(chain.placements, chain.sliding, joints, strict=False):
        position = position + rotation @ placement[:, 3]
        rotation = rotation @ placement[:, :3]
        if sliding:
            position = position + rotation[:, 2] * joint
        else:
            rotation = rotation @ _about_z(joint)
    last = chain.placements[-1]
    return np.column_stack((rotation @ last[:, :3], position + rotation @ last[:, 3]))


def jacobian_of(chain: KinematicChain, axes: Array, points: Array, tool: Array) -> Array:
    """Return the Jacobian (6, n) of a configuration with these joint lines and tool pose (3, 4)."""
    arms = tool[:, 3] - points
    moving = np.where(chain.sliding[:, None], axes, np.cross(axes, arms))
    turning = np.where(chain.sliding[:, None], 0.0, axes)
    return np.hstack((moving, turning)).T


def _placements(axes: Array, points: Array, tool: Array) -> Array:
    frames = [np.column_stack((_frame_along(axis), point)) for axis, point in zip(axes, points, strict=True)]
    placements = np.empty((len(axes) + 1, 3, 4))
    rotation, position = np.eye(3), np.zeros(3)
    for placement, frame in zip(placements, [*frames, tool], strict=True):
        placement[:, :3] = rotation.T @ frame[:, :3]
        placement[:, 3] = rotation.T @ (frame[:, 3] - position)
        rotation, position = frame[:, :3], frame[:, 3]
    return placements


def _frame_along(axis: Array) -> Array:
    """Return a rotation matrix whose third column is `axis`."""
    other = np.zeros(3)
    other[int(np.argmin(np.abs(axis)))] = 1.0
    x = np.cross(other, axis)
    x /= np.linalg.norm(x)
    return np.column_stack((x, np.cross(axis, x), axis))


def _about_z(angle: float) -> Array:
    cosine, sine = np.cos(angle), np.sin(angle)
    return np.array([[cosine, -sine, 0.0], [sine, cosine, 0.0], [0.0, 0.0, 1.0]])


def _check(chain: KinematicChain, kinematics: ArmKinematics) -> None:
    lower, upper = chain.bounds[:2]
    for share in (0.21, 0.83):
        # A different share for each joint, so that no two move equally.
        joints = lower + (upper - lower) * ((share + 0.37 * np.arange(chain.dof)) % 1.0)
        off = float(np.abs(tool_at(chain, joints) - matrix_of(kinematics.tool_pose(joints))).max())
        if off > _AGREEMENT:
            raise CellError(
                f"the arm is not a serial chain of one-axis joints: tool pose error {off:.2g}",
                where=kinematics.model.name,
                hint="every arm joint must move the tool about or along one axis, independently of the other joints",
            )
