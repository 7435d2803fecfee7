"""A robot model's URDF as a MuJoCo specification: primitive collision shapes, motors, added gripper pads.

MuJoCo reads URDF but neither `package://` URIs nor DAE meshes, so visuals are dropped (the view
draws them from the files) and mesh paths are made absolute before parsing.
"""

from __future__ import annotations

import xml.etree.ElementTree as ET
from pathlib import Path
from typing import Any

from robots.model.robot_model import RobotModel
from robots.model.urdf.description import resolve_uri
from robots.sim.physics.physics import mujoco
from robots.sim.physics.tool_body import add_motor, tool_body


def arm_spec(model: RobotModel) -> Any:
    """Return the specification of one arm, torque motors named like the joints they drive.

    Raises:
        CellError: a mesh file of the description is missing.
    """
    spec = mujoco.MjSpec.from_string(_collision_only_urdf(model))
    for name, armature, effort in zip(model.arm_joints, model.armature_kg_m2, model.limits.effort_nm, strict=True):
        spec.joint(name).armature = armature
        add_motor(spec, name, effort)
    if model.tool is not None:
        tool_body(model.tool).finish(spec, model.tool)
    for a, b in model.allowed_collisions:
        spec.add_exclude(bodyname1=a, bodyname2=b)
    return spec


def _collision_only_urdf(model: RobotModel) -> str:
    """Return the URDF as MuJoCo reads it: without visuals, meshes by absolute path."""
    robot = ET.fromstring(model.urdf_text)  # noqa: S314 - our composed URDF
    for link in robot.iter("link"):
        for visual in link.findall("visual"):
            link.remove(visual)
    for mesh in robot.iter("mesh"):
        path = resolve_uri(mesh.attrib["filename"], package_dirs=model.package_dirs, relative_to=Path())
        mesh.attrib["filename"] = str(path)
    compiler = ET.SubElement(ET.SubElement(robot, "mujoco"), "compiler")
    # Links without mass (flange, tool frame) get the smallest mass that the solver accepts.
    compiler.attrib.update(
        fusestatic="false", strippath="false", balanceinertia="true", boundmass="1e-9", boundinertia="1e-12"
    )
    return ET.tostring(robot, encoding="unicode")
