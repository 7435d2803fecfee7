"""Forward kinematics of an arm's links from the URDF that the arm publishes."""

from __future__ import annotations

import xml.etree.ElementTree as ET
from collections.abc import Collection, Mapping
from dataclasses import dataclass

import numpy as np

from editor_web.cell_view.rendering.transforms import Matrix, inverse
from engine.errors import FlexcellError

_TURNING = frozenset({"revolute", "continuous"})


@dataclass(frozen=True, kw_only=True)
class UrdfJoint:
    """One joint of a URDF; `origin` is the child's frame in the parent's at joint value 0 (4 x 4, metres)."""

    name: str
    kind: str
    parent: str
    child: str
    origin: Matrix
    axis: Matrix

    def at(self, value: float) -> Matrix:
        """Return the child's frame in the parent's at `value`, radians or metres."""
        moved = np.eye(4)
        if self.kind in _TURNING:
            moved[:3, :3] = _about(self.axis, value)
        elif self.kind == "prismatic":
            moved[:3, 3] = self.axis * value
        return self.origin @ moved


class UrdfTree:
    """The tree of links of one arm and its tool.

    Args:
        urdf: The URDF's text.

    Raises:
        FlexcellError: it is not XML, or not a tree with one root.
    """

    def __init__(self, urdf: str) -> None:
        try:
            robot = ET.fromstring(urdf)  # noqa: S314 - our composed URDF
        except ET.ParseError as error:
            raise FlexcellError(f"the description of the arm cannot be read: {error}") from error
        joints = [_joint(element) for element in robot.findall("joint")]
        children = {joint.child for joint in joints}
        roots = [name for link in robot.findall("link") if (name := link.get("name", "")) not in children]
        if len(roots) != 1 or len(children) != len(joints):
            raise FlexcellError("the links of the arm's description are not a tree", where=robot.get("name"))
        self.root = roots[0]
        self._joints = _from_the_root(self.root, joints)

    def moved_by(self, joints: Collection[str]) -> frozenset[str]:
        """Return the links that these joints move."""
        moved: set[str] = set()
        for joint in self._joints:
            if joint.name in joints or joint.parent in moved:
                moved.add(joint.child)
        return frozenset(moved)

    def links(self, base: Matrix, joints: Mapping[str, float], *, seen: Mapping[str, Matrix]) -> dict[str, Matrix]:
        """Return the frame of each link in the world.

        Args:
            base: The frame of the root link in the world.
            joints: Values by joint name; other joints keep the relative pose in `seen`, else they are at 0.
            seen: Measured frames of links in the world, possibly at another time.
        """
        frames = {self.root: base}
        for joint in self._joints:
            parent = frames[joint.parent]
            if joint.name not in joints and joint.parent in seen and joint.child in seen:
                frames[joint.child] = parent @ inverse(seen[joint.parent]) @ seen[joint.child]
            else:
                frames[joint.child] = parent @ joint.at(joints.get(joint.name, 0.0))
        return frames


def _joint(element: ET.Element) -> UrdfJoint:
    origin, axis = element.find("origin"), element.find("axis")
    frame = np.eye(4)
    if origin is not None:
        frame[:3, :3] = _from_rpy(_numbers(origin.get("rpy", "0 0 0")))
        frame[:3, 3] = _numbers(origin.get("xyz", "0 0 0"))
    direction = _numbers("1 0 0" if axis is None else axis.get("xyz", "1 0 0"))
    ends = {end: found.get("link", "") for end in ("parent", "child") if (found := element.find(end)) is not None}
    return UrdfJoint(
        name=element.get("name", ""),
        kind=element.get("type", "fixed"),
        parent=ends.get("parent", ""),
        child=ends.get("child", ""),
        origin=frame,
        axis=direction / max(float(np.linalg.norm(direction)), 1e-12),
    )


def _from_the_root(root: str, joints: list[UrdfJoint]) -> tuple[UrdfJoint, ...]:
    """Return the joints in topological order, parents first."""
    below: dict[str, list[UrdfJoint]] = {}
    for joint in joints:
        below.setdefault(joint.parent, []).append(joint)
    ordered, links = list[UrdfJoint](), [root]
    while links:
        found = below.get(links.pop(), [])
        ordered += found
        links += [joint.child for joint in found]
    if len(ordered) != len(joints):
        raise FlexcellError("a joint of the arm's description has no parent link", where=root)
    return tuple(ordered)


def _numbers(text: str) -> Matrix:
    numbers = np.array([float(word) for word in text.split()])
    if numbers.shape != (3,):
        raise FlexcellError(f"expected three numbers in the arm's description, got {text!r}")
    return numbers


def _from_rpy(rpy: Matrix) -> Matrix:
    """Return the rotation about the fixed axes x, then y, then z."""
    x, y, z = (_about(np.eye(3)[row], float(rpy[row])) for row in range(3))
    return z @ y @ x


def _about(axis: Matrix, angle_rad: float) -> Matrix:
    x, y, z = axis
    cross = np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
    return np.eye(3) + np.sin(angle_rad) * cross + (1 - np.cos(angle_rad)) * (cross @ cross)
