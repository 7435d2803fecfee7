"""The master plate of a tool changer, as links of the URDF of its arm."""

from __future__ import annotations

import xml.etree.ElementTree as ET

from engine.document import ToolChangerSpec
from engine.errors import CellError
from robots.model.urdf.urdf_tree import Element, add_fixed_joint, links_of

MASTER_PLATE = "master_plate"
"""The link of the plate."""
MASTER_FACE = "master_face"
"""The link whose origin is in the middle of its face, where tool plates meet it; z points out of it."""

_COLOUR = "0.35 0.37 0.40 1.0"


def add_master_plate(robot: Element, changer: ToolChangerSpec, *, flange: str) -> str:
    """Fix the plate, a cylinder about the flange's z axis, to the flange; return the link of its face.

    Raises:
        CellError: the arm has links of these names.
    """
    clash = {MASTER_PLATE, MASTER_FACE} & links_of(robot).keys()
    if clash:
        raise CellError(f"the arm has a link {min(clash)} of its own", hint="rename it, or remove `tool_changer`")
    radius, length, mass = changer.diameter_m / 2.0, changer.thickness_m, changer.mass_kg
    link = ET.SubElement(robot, "link", name=MASTER_PLATE)
    inertial = ET.SubElement(link, "inertial")
    _origin(inertial, length / 2.0)
    ET.SubElement(inertial, "mass", value=repr(mass))
    across, along = mass * (3.0 * radius**2 + length**2) / 12.0, mass * radius**2 / 2.0
    ET.SubElement(inertial, "inertia", ixx=repr(across), iyy=repr(across), izz=repr(along), ixy="0", ixz="0", iyz="0")
    for kind in ("visual", "collision"):
        element = ET.SubElement(link, kind)
        _origin(element, length / 2.0)
        ET.SubElement(ET.SubElement(element, "geometry"), "cylinder", radius=repr(radius), length=repr(length))
        if kind == "visual":
            ET.SubElement(ET.SubElement(element, "material", name=MASTER_PLATE), "color", rgba=_COLOUR)
    ET.SubElement(robot, "link", name=MASTER_FACE)
    nowhere = (0.0, 0.0, 0.0)
    add_fixed_joint(robot, "master_plate_mount", parent=flange, child=MASTER_PLATE, xyz=nowhere, rpy=nowhere)
    at = (0.0, 0.0, length)
    add_fixed_joint(robot, "master_face_joint", parent=MASTER_PLATE, child=MASTER_FACE, xyz=at, rpy=nowhere)
    return MASTER_FACE


def _origin(element: Element, z: float) -> None:
    ET.SubElement(element, "origin", xyz=f"0 0 {z!r}", rpy="0 0 0")
