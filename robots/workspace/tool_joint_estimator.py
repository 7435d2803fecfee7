"""Computes the joints of a tool from the measured poses of its links, for any tool and drive."""

from __future__ import annotations

import math
import xml.etree.ElementTree as ET
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from robots.model.robot_model import RobotModel
from robots.model.transform import RigidTransform, product, quaternion_of
from robots.model.urdf.urdf_tree import ends_of, joints_of
from robots.port import Array


@dataclass(frozen=True, kw_only=True)
class _Joint:
    name: str
    parent: str
    child: str
    origin: RigidTransform
    axis: Array
    slides: bool


class ToolJointEstimator:
    """Computes the joints of one arm's tool from the poses of its links."""

    def __init__(self, model: RobotModel) -> None:
        urdf = ET.fromstring(model.urdf_text)  # noqa: S314 - our composed URDF
        names = model.tool.joints if model.tool is not None else ()
        every = joints_of(urdf)
        self._joints = tuple(_joint(name, every[name]) for name in names)

    def read(self, link: Callable[[str], RigidTransform]) -> tuple[tuple[str, float], ...]:
        """Return the joints by name, radians or meters; `link` returns the pose of a link."""
        return tuple((joint.name, _value(joint, link)) for joint in self._joints)


def _joint(name: str, element: ET.Element) -> _Joint:
    parent, child = ends_of(element)
    origin, axis = element.find("origin"), element.find("axis")
    xyz = _numbers(origin, "xyz", "0 0 0")
    roll, pitch, yaw = _numbers(origin, "rpy", "0 0 0").tolist()
    rotation = product(
        quaternion_of(np.array([0.0, 0.0, yaw])),
        product(quaternion_of(np.array([0.0, pitch, 0.0])), quaternion_of(np.array([roll, 0.0, 0.0]))),
    )
    direction = _numbers(axis, "xyz", "1 0 0")
    return _Joint(
        name=name,
        parent=parent,
        child=child,
        origin=RigidTransform(xyz=xyz, xyzw=rotation),
        axis=direction / np.linalg.norm(direction),
        slides=element.attrib["type"] == "prismatic",
    )


def _numbers(element: ET.Element | None, key: str, default: str) -> Array:
    text = element.get(key, default) if element is not None else default
    return np.array([float(word) for word in text.split()])


def _value(joint: _Joint, link: Callable[[str], RigidTransform]) -> float:
    moved = link(joint.parent).then(joint.origin).inverse().then(link(joint.child))
    if joint.slides:
        return float(joint.axis @ moved.xyz)
    angle = 2.0 * math.atan2(float(joint.axis @ moved.xyzw[:3]), float(moved.xyzw[3]))
    return math.remainder(angle, 2.0 * math.pi)
