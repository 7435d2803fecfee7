"""A robot model's URDF as a MuJoCo specification: primitive collision shapes, motors, own gripper pads.

MuJoCo reads URDF but neither `package://` URIs nor DAE meshes, so visuals are dropped (the view
draws them from the files) and mesh paths are made absolute before parsing.
"""

from __future__ import annotations

import xml.etree.ElementTree as ET
from typing import Any

import numpy as np

from robots.model.description import resolve_uri
from robots.model.robot_model import GripperModel, PadBox, RobotModel
from robots.sim.physics import mujoco

# Inertia of a joint's motor behind its gear, seen at the joint: 0.1 kg m² is the usual figure for
# the Panda's harmonic drives; the hand's spindle seen at one finger is about 0.2 kg.
_JOINT_ARMATURE_KG_M2 = 0.1
_FINGER_ARMATURE_KG = 0.2

# Pad contact as measured best for holding without slip: stiff, elliptic, torsional friction (condim 4).
_PAD_FRICTION = (0.8, 0.005, 0.0001)
_PAD_SOLREF = (0.004, 1.0)
_PAD_SOLIMP = (0.95, 0.99, 0.001, 0.5, 2.0)


def pad_geom_name(pad: PadBox) -> str:
    """Return the name of a pad's collision geometry before prefixing."""
    return f"{pad.link}_pad"


def arm_spec(model: RobotModel) -> Any:
    """Return the specification of one arm, torque motors named like the joints they drive.

    Raises:
        CellError: a mesh file of the description is missing.
    """
    spec = mujoco.MjSpec.from_string(_collision_only_urdf(model))
    for name in model.arm_joints:
        joint = spec.joint(name)
        joint.armature = _JOINT_ARMATURE_KG_M2
        limit = model.limits.effort_nm[model.arm_joints.index(name)]
        _add_motor(spec, name, limit)
    if model.gripper is not None:
        _finish_gripper(spec, model.gripper)
    for a, b in model.allowed_collisions:
        spec.add_exclude(bodyname1=a, bodyname2=b)
    return spec


def _add_motor(spec: Any, joint: str, limit: float) -> None:
    motor = spec.add_actuator(name=joint, target=joint, trntype=mujoco.mjtTrn.mjTRN_JOINT)
    motor.set_to_motor()
    motor.ctrllimited = True
    motor.ctrlrange = [-limit, limit]


def _finish_gripper(spec: Any, gripper: GripperModel) -> None:
    for name in gripper.finger_joints:
        joint = spec.joint(name)
        joint.armature = _FINGER_ARMATURE_KG
        joint.actfrclimited = mujoco.mjtLimited.mjLIMITED_FALSE
        _add_motor(spec, name, gripper.max_force_n)
    for pad in gripper.pads:
        body = spec.body(pad.link)
        for geom in list(body.geoms):
            if _is_the_described_tip(geom, pad):
                spec.delete(geom)
        body.add_geom(
            name=pad_geom_name(pad),
            type=mujoco.mjtGeom.mjGEOM_BOX,
            pos=list(pad.xyz),
            size=[edge / 2 for edge in pad.size_m],
            density=0.0,
            condim=4,
            priority=1,
            friction=list(_PAD_FRICTION),
            solref=list(_PAD_SOLREF),
            solimp=list(_PAD_SOLIMP),
        )


def _is_the_described_tip(geom: Any, pad: PadBox) -> bool:
    inside = np.abs(np.asarray(geom.pos) - np.asarray(pad.xyz)) < np.asarray(pad.size_m) / 2
    return bool(inside.all())


def _collision_only_urdf(model: RobotModel) -> str:
    """Return the primitive URDF without visuals; hand and fingers get the shapes of the detailed one.

    The primitive description covers the fingers with 15 mm spheres, which cannot grasp.
    """
    robot = ET.parse(model.collision_urdf).getroot()
    detailed = {link.attrib["name"]: link for link in ET.parse(model.urdf).getroot().iter("link")}
    gripper = model.gripper
    exact = {gripper.hand_link, *gripper.finger_links} if gripper is not None else set[str]()
    for link in robot.iter("link"):
        for visual in link.findall("visual"):
            link.remove(visual)
        if link.attrib["name"] in exact:
            for shape in link.findall("collision"):
                link.remove(shape)
            link.extend(detailed[link.attrib["name"]].findall("collision"))
    for mesh in robot.iter("mesh"):
        path = resolve_uri(
            mesh.attrib["filename"], package_dir=model.package_dir, relative_to=model.collision_urdf.parent
        )
        mesh.attrib["filename"] = str(path)
    compiler = ET.SubElement(ET.SubElement(robot, "mujoco"), "compiler")
    # Links without mass (flange, tool frame) get the smallest one that the solver accepts.
    compiler.attrib.update(
        fusestatic="false", strippath="false", balanceinertia="true", boundmass="1e-9", boundinertia="1e-12"
    )
    return ET.tostring(robot, encoding="unicode")
