"""Validates a URDF for all its users (kinematics, collision, simulation, view)."""

from __future__ import annotations

import math
from collections.abc import Mapping
from pathlib import Path
from xml.etree.ElementTree import Element

from engine.errors import CellError

MAX_LINKS = 512
"""Maximum links, and joints, of one model."""
MAX_SHAPES = 4096
"""Maximum visual and collision shapes of one model."""
_MAX_NUMBER = 1e9
_JOINT_TYPES = ("fixed", "revolute", "continuous", "prismatic")
_NUMBERS: Mapping[str, Mapping[str, int]] = {
    "origin": {"xyz": 3, "rpy": 3},
    "axis": {"xyz": 3},
    "limit": dict.fromkeys(("lower", "upper", "effort", "velocity"), 1),
    "mimic": dict.fromkeys(("multiplier", "offset"), 1),
    "dynamics": dict.fromkeys(("damping", "friction"), 1),
    "mass": {"value": 1},
    "inertia": dict.fromkeys(("ixx", "ixy", "ixz", "iyy", "iyz", "izz"), 1),
    "box": {"size": 3},
    "cylinder": {"radius": 1, "length": 1},
    "sphere": {"radius": 1},
    "mesh": {"scale": 3},
    "color": {"rgba": 4},
}
_REQUIRED: Mapping[str, tuple[str, ...]] = {
    "mass": ("value",),
    "inertia": ("ixx", "ixy", "ixz", "iyy", "iyz", "izz"),
    "box": ("size",),
    "cylinder": ("radius", "length"),
    "sphere": ("radius",),
    "mesh": ("filename",),
    "mimic": ("joint",),
    "color": ("rgba",),
}


def verify_urdf(robot: Element, *, where: Path) -> None:
    """Check the links and joints of a `robot` element: unique names, one tree, plain numbers.

    Raises:
        CellError: states the first error.
    """
    try:
        links = _names(robot, "link")
        _names(robot, "joint")
        _verify_tree(robot, links)
        shapes = 0
        for element in robot.iter():
            shapes += element.tag in ("visual", "collision")
            _verify_attributes(element)
        if shapes > MAX_SHAPES:
            raise ValueError(f"it has {shapes} shapes, more than {MAX_SHAPES}")
    except ValueError as error:
        raise CellError(f"the URDF is wrong: {error}", where=str(where), hint="correct the model folder") from error


def _names(robot: Element, tag: str) -> set[str]:
    elements = robot.findall(tag)
    if len(elements) > MAX_LINKS:
        raise ValueError(f"it has {len(elements)} {tag}s, more than {MAX_LINKS}")
    names: set[str] = set()
    for element in elements:
        name = element.get("name", "")
        if not name or name in names:
            raise ValueError(f"a {tag} has no name" if not name else f"there are two {tag}s {name:.80}")
        names.add(name)
    return names


def _verify_tree(robot: Element, links: set[str]) -> None:
    parents: dict[str, str] = {}
    for joint in robot.findall("joint"):
        name = joint.attrib["name"]
        if joint.get("type") not in _JOINT_TYPES:
            raise ValueError(f"the type of the joint {name:.80} is not one of {', '.join(_JOINT_TYPES)}")
        ends = [end.get("link", "") for tag in ("parent", "child") for end in joint.findall(tag)]
        if len(ends) != 2 or not links.issuperset(ends):
            raise ValueError(f"the joint {name:.80} does not connect one parent link to another child link")
        if ends[1] in parents:
            raise ValueError(f"the link {ends[1]:.80} has two parent joints")
        parents[ends[1]] = ends[0]
    roots = [link for link in links if link not in parents]
    if len(roots) != 1:
        raise ValueError(f"its links do not form one tree: {len(roots)} of them have no parent")
    for link in links:
        _verify_ancestors(link, parents)


def _verify_ancestors(link: str, parents: Mapping[str, str]) -> None:
    at, steps = link, 0
    while at in parents:
        at, steps = parents[at], steps + 1
        if steps > len(parents):
            raise ValueError(f"the link {link:.80} is its own ancestor")


def _verify_attributes(element: Element) -> None:
    for key in _REQUIRED.get(element.tag, ()):
        if key not in element.attrib:
            raise ValueError(f"a `{element.tag}` has no `{key}`")
    for key, count in _NUMBERS.get(element.tag, {}).items():
        if key in element.attrib:
            _verify_numbers(element, key, count)


def _verify_numbers(element: Element, key: str, count: int) -> None:
    text = element.attrib[key]
    try:
        numbers = [float(word) for word in text.split()]
    except ValueError:
        numbers = []
    if len(numbers) != count or not all(math.isfinite(number) and abs(number) <= _MAX_NUMBER for number in numbers):
        expected = "a number" if count == 1 else f"{count} numbers"
        raise ValueError(f'`{element.tag} {key}="{text:.40}"` is not {expected} below {_MAX_NUMBER:g}')
    if element.tag in ("mass", "box", "cylinder", "sphere") and min(numbers) < 0.0:
        raise ValueError(f'`{element.tag} {key}="{text:.40}"` is negative')
