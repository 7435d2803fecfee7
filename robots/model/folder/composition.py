"""Composes an arm's folder, a tool's folder and a calibration into one `RobotModel` with one URDF."""

from __future__ import annotations

import xml.etree.ElementTree as ET
from itertools import product
from pathlib import Path

import numpy as np

from engine.document import DataPath, ToolChangerSpec
from engine.errors import CellError
from robots.model.folder.calibration import apply_calibration, load_calibration
from robots.model.folder.folder_document import FileReference, RobotDocument, ToolDocument
from robots.model.folder.master_plate import MASTER_PLATE, add_master_plate
from robots.model.folder.model_folder import ModelFolder
from robots.model.joint_map import JointMap
from robots.model.robot_model import JointFriction, JointLimits, RobotModel
from robots.model.tool_model import ToolModel
from robots.model.urdf.urdf_tree import (
    Element,
    add_fixed_joint,
    add_prefix,
    ends_of,
    joints_of,
    links_of,
    mass_of,
    root_of,
    scale_mass,
    set_limits,
)

Pairs = tuple[tuple[str, str], ...]


def compose(
    arm: ModelFolder[RobotDocument],
    tool: ModelFolder[ToolDocument] | None,
    *,
    calibration: Path | None = None,
    coupled_joints: bool = False,
    changer: ToolChangerSpec | None = None,
) -> RobotModel:
    """Return the model of an arm with a tool at its flange, or with the master plate of a tool changer.

    Raises:
        CellError: descriptions are not installed, names clash, or the arm has no such option.
        DocumentError: a document and its URDF do not match; `where` is the position.
    """
    document = arm.document
    robot = arm.urdf()
    _check_arm(arm, robot)
    calibrated = ""
    if calibration is not None:
        nominal = document.calibration
        if nominal is None:
            raise CellError(
                f"the robot model {document.robot} does not support calibration files", hint="remove `calibration`"
            )
        factory = load_calibration(calibration)
        apply_calibration(
            robot, nominal, factory, nominal=load_calibration(arm.locate(FileReference(file=nominal.nominal)))
        )
        calibrated = factory.hash
    for joint in document.joints:
        set_limits(
            joints_of(robot)[joint.name],
            lower=joint.lower_rad,
            upper=joint.upper_rad,
            velocity=joint.velocity_rad_s,
            effort=joint.effort_nm,
        )
    directories = [arm.package_dir(document.urdf)]
    base_link, tool_link, tool_model = root_of(robot), document.flange, None
    allowed = arm.allowed_collisions()
    if tool is not None:
        hand_side = _rigid_to(robot, document.flange)
        tool_model, tool_link = _join(robot, tool, flange=document.flange)
        directories.append(tool.package_dir(tool.document.urdf))
        shaped = {name for name, link in links_of(robot).items() if link.find("collision") is not None}
        allowed += tuple(pair for pair in product(hand_side, tool_model.links) if shaped.issuperset(pair))
        prefix = _prefix(tool.document)
        allowed += tuple((prefix + a, prefix + b) for a, b in tool.allowed_collisions())
    elif changer is not None:
        allowed += tuple((link, MASTER_PLATE) for link in _rigid_to(robot, document.flange))
        tool_link = add_master_plate(robot, changer, flange=document.flange)
    return RobotModel(
        name=document.robot,
        title=document.title,
        urdf_text=ET.tostring(robot, encoding="unicode"),
        package_dirs=tuple(dict.fromkeys(directories)),
        base_link=base_link,
        flange_link=document.flange,
        tool_link=tool_link,
        arm_joints=tuple(joint.name for joint in document.joints),
        limits=_limits(document),
        friction=_friction(document),
        home_rad=tuple(joint.home_rad for joint in document.joints),
        armature_kg_m2=tuple(joint.armature_kg_m2 for joint in document.joints),
        tool=tool_model,
        allowed_collisions=_present_pairs(robot, allowed),
        joint_map=_joint_map(document, coupled=coupled_joints),
        calibration=calibrated,
        licence=document.licence.name,
        licence_file=arm.locate(document.licence),
        digital_outputs=document.digital_outputs,
        digital_inputs=document.digital_inputs,
    )


def _check_arm(arm: ModelFolder[RobotDocument], robot: Element) -> None:
    document = arm.document
    joints: list[tuple[DataPath, str]] = [(("joints", i, "name"), j.name) for i, j in enumerate(document.joints)]
    arm.require_joints(robot, joints)
    arm.require_links(robot, [(("flange",), document.flange)])
    for name, joint in joints_of(robot).items():
        named = name in {j.name for j in document.joints}
        if not named and joint.attrib["type"] != "fixed":
            raise CellError(
                f"the movable joint {name} of the URDF is missing under `joints`",
                where=document.robot,
                hint="list it, or remove its link with `urdf: {without: […]}`",
            )


def _join(robot: Element, tool: ModelFolder[ToolDocument], *, flange: str) -> tuple[ToolModel, str]:
    """Add the tool's links and joints to `robot`; return the tool and the link of its centre point."""
    document = tool.document
    tree = tool.urdf()
    tool.require_joints(tree, [(("mechanism",), name) for name in document.mechanism.joint_names()])
    tool.require_links(tree, [(("mechanism",), name) for name in document.mechanism.link_names()])
    if document.mass_kg is not None:
        scale_mass(tree, document.mass_kg)
    centre, mass = document.tcp, mass_of(tree)
    at = centre.link if centre.link is not None else root_of(tree)
    tool.require_links(tree, [(("tcp", "link"), at)])
    if (*centre.xyz, *centre.rpy) != (0.0,) * 6:
        ET.SubElement(tree, "link", name="tcp")
        add_fixed_joint(tree, "tcp_joint", parent=at, child="tcp", xyz=centre.xyz, rpy=centre.rpy)
        at = "tcp"
    prefix = _prefix(document)
    add_prefix(tree, prefix)
    clash = sorted((set(links_of(robot)) & set(links_of(tree))) | (set(joints_of(robot)) & set(joints_of(tree))))
    if clash:
        raise CellError(
            f"arm and tool both have a link or joint {clash[0]}", where=document.tool, hint="give the tool a `prefix`"
        )
    root = root_of(tree)
    add_fixed_joint(robot, f"{root}_mount", parent=flange, child=root, xyz=document.mount.xyz, rpy=document.mount.rpy)
    moving = tuple(name for name, joint in joints_of(tree).items() if joint.attrib["type"] != "fixed")
    model = ToolModel(
        name=document.tool,
        kind=str(document.mechanism.__struct_config__.tag),
        root_link=root,
        links=tuple(links_of(tree)),
        joints=moving,
        mass_kg=mass,
        mechanism=document.mechanism.with_prefix(prefix),
        licence=document.licence.name,
        licence_file=tool.locate(document.licence),
    )
    robot.extend(list(tree))
    return model, prefix + at


def _prefix(document: ToolDocument) -> str:
    return f"{document.tool}_" if document.prefix is None else document.prefix


def _rigid_to(robot: Element, link: str) -> tuple[str, ...]:
    """Return the links that move together with `link`, itself included, in file order."""
    found = {link}
    fixed = [ends_of(joint) for joint in robot.findall("joint") if joint.attrib["type"] == "fixed"]
    while True:
        more = {end for pair in fixed for end in pair if found & set(pair)} - found
        if not more:
            return tuple(name for name in links_of(robot) if name in found)
        found |= more


def _present_pairs(robot: Element, pairs: Pairs) -> Pairs:
    """Return the pairs whose links exist, each once, in order."""
    present, seen, kept = links_of(robot), set[frozenset[str]](), list[tuple[str, str]]()
    for a, b in pairs:
        if a in present and b in present and frozenset((a, b)) not in seen:
            seen.add(frozenset((a, b)))
            kept.append((a, b))
    return tuple(kept)


def _limits(document: RobotDocument) -> JointLimits:
    joints = document.joints
    return JointLimits(
        lower_rad=tuple(joint.lower_rad for joint in joints),
        upper_rad=tuple(joint.upper_rad for joint in joints),
        velocity_rad_s=tuple(joint.velocity_rad_s for joint in joints),
        acceleration_rad_s2=tuple(joint.acceleration_rad_s2 for joint in joints),
        jerk_rad_s3=tuple(joint.jerk_rad_s3 for joint in joints),
        effort_nm=tuple(joint.effort_nm for joint in joints),
    )


def _friction(document: RobotDocument) -> JointFriction:
    return JointFriction(
        coulomb_nm=tuple(joint.coulomb_nm for joint in document.joints),
        viscous_nms_rad=tuple(joint.viscous_nms_rad for joint in document.joints),
    )


def _joint_map(document: RobotDocument, *, coupled: bool) -> JointMap:
    names = [joint.name for joint in document.joints]
    if coupled and not any(device.optional for device in document.device_joints):
        raise CellError(f"the joints of {document.robot} are not coupled", hint="remove `coupled_joints`")
    matrix, offset = np.eye(len(names)), np.zeros(len(names))
    lower, upper = np.full(len(names), -np.inf), np.full(len(names), np.inf)
    for device in document.device_joints:
        if device.optional and not coupled:
            continue
        row = names.index(device.joint)
        for other, factor in device.plus.items():
            matrix[row, names.index(other)] += factor
        offset[row] += device.offset_rad
        lower[row] = -np.inf if device.lower_rad is None else device.lower_rad
        upper[row] = np.inf if device.upper_rad is None else device.upper_rad
    return JointMap(
        matrix=tuple(tuple(row) for row in matrix.tolist()),
        offset_rad=tuple(offset.tolist()),
        lower_rad=tuple(lower.tolist()),
        upper_rad=tuple(upper.tolist()),
    )
