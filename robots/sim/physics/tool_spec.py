"""Completes the specification of a tool: pads, motors, tendon, magnet face; the rest is in its URDF."""

from __future__ import annotations

from typing import Any

import numpy as np

from robots.model.tool_model import ClawModel, GripperModel, LinkageModel, MagnetModel, PadBox, SynergyModel, ToolModel
from robots.sim.physics.physics import mujoco

# Pad contact that measured best for holding without slip: stiff, elliptic, torsional friction (condim 4).
_PAD_FRICTION = (0.8, 0.005, 0.0001)
_PAD_SOLREF = (0.004, 1.0)
_PAD_SOLIMP = (0.95, 0.99, 0.001, 0.5, 2.0)
# Skin of a soft hand.
_SKIN_FRICTION = (1.0, 0.01, 0.0005)
# Ground steel on steel.
_FACE_FRICTION = (0.4, 0.003, 0.0001)
# The rods of a linkage are stiff; half a step more than the solver needs for stability.
_ROD_SOLREF = (0.005, 1.0)
_ROD_SOLIMP = (0.99, 0.999, 0.0005, 0.5, 2.0)
_PHALANX_ARMATURE_KG_M2 = 2e-5

TENDON = "tendon"
FACE = "face"


def pad_geom_name(pad: PadBox) -> str:
    """Return the name of a pad's collision geometry before prefixing."""
    return f"{pad.link}_pad"


def add_motor(spec: Any, joint: str, limit: float) -> None:
    """Add a motor of at most `limit` newton or newton metre, named like its joint."""
    motor = spec.add_actuator(name=joint, target=joint, trntype=mujoco.mjtTrn.mjTRN_JOINT)
    motor.set_to_motor()
    motor.ctrllimited = True
    motor.ctrlrange = [-limit, limit]


def finish_tool(spec: Any, tool: ToolModel) -> None:
    """Add the gripping elements of the tool to the specification of an arm."""
    match tool.mechanism:
        case GripperModel() as gripper:
            for name in gripper.finger_joints:
                joint = spec.joint(name)
                joint.armature = gripper.armature_kg
                joint.actfrclimited = mujoco.mjtLimited.mjLIMITED_FALSE
                add_motor(spec, name, gripper.max_force_n)
            for pad in gripper.pads:
                _add_pad(spec, pad)
        case LinkageModel() | ClawModel() as linkage:
            _finish_linkage(spec, linkage)
        case SynergyModel() as hand:
            _finish_hand(spec, tool, hand)
        case MagnetModel() as magnet:
            _add_box(spec, magnet.face, name=FACE, friction=_FACE_FRICTION)


def _finish_linkage(spec: Any, linkage: LinkageModel | ClawModel) -> None:
    factors = {linkage.driver: 1.0, **dict(linkage.followers)}
    # The motor's inertia is spread over all joints that it turns: light joints cause soft contacts.
    share = linkage.armature_kg_m2 / sum(factor**2 for factor in factors.values())
    for name in factors:
        joint = spec.joint(name)
        joint.armature = share
        joint.actfrclimited = mujoco.mjtLimited.mjLIMITED_FALSE
    # The servo limits the pad force; the joint torque for it depends on the angle.
    stroke = abs(linkage.closed_rad - linkage.open_rad)
    if isinstance(linkage, ClawModel):
        add_motor(spec, linkage.driver, linkage.max_effort_nm)
    else:
        add_motor(spec, linkage.driver, 2.0 * linkage.max_force_n * linkage.max_width_m / stroke)
    for equality in spec.equalities:
        if equality.name1 in factors:
            equality.solref = list(_ROD_SOLREF)
            equality.solimp = list(_ROD_SOLIMP)
    for pad in linkage.pads:
        _add_pad(spec, pad)


def _finish_hand(spec: Any, tool: ToolModel, hand: SynergyModel) -> None:
    tendon = spec.add_tendon(name=TENDON)
    for flexed in (*hand.flexion, *hand.passive):
        joint = spec.joint(flexed.name)
        joint.stiffness[0] = flexed.stiffness_nm_rad
        joint.damping[0] = flexed.damping_nms_rad
        joint.springref = 0.0
        joint.armature = _PHALANX_ARMATURE_KG_M2
        joint.solref_limit = list(_ROD_SOLREF)
        if flexed.radius_m:
            tendon.wrap_joint(flexed.name, flexed.radius_m)
    motor = spec.add_actuator(name=TENDON, target=TENDON, trntype=mujoco.mjtTrn.mjTRN_TENDON)
    motor.set_to_motor()
    motor.ctrllimited = True
    motor.ctrlrange = [0.0, hand.max_force_n]
    for link in tool.links:
        for geom in spec.body(link).geoms:
            geom.condim, geom.priority = 4, 1
            geom.friction = list(_SKIN_FRICTION)
            geom.solref, geom.solimp = list(_PAD_SOLREF), list(_PAD_SOLIMP)


def _add_pad(spec: Any, pad: PadBox) -> None:
    body = spec.body(pad.link)
    for geom in list(body.geoms):
        if _is_the_described_tip(geom, pad):
            spec.delete(geom)
    _add_box(spec, pad, name=pad_geom_name(pad), friction=_PAD_FRICTION)


def _add_box(spec: Any, pad: PadBox, *, name: str, friction: tuple[float, float, float]) -> None:
    spec.body(pad.link).add_geom(
        name=name,
        type=mujoco.mjtGeom.mjGEOM_BOX,
        pos=list(pad.xyz),
        size=[edge / 2 for edge in pad.size_m],
        density=0.0,
        condim=4,
        priority=1,
        friction=list(friction),
        solref=list(_PAD_SOLREF),
        solimp=list(_PAD_SOLIMP),
    )


def _is_the_described_tip(geom: Any, pad: PadBox) -> bool:
    inside = np.abs(np.asarray(geom.pos) - np.asarray(pad.xyz)) < np.asarray(pad.size_m) / 2
    return bool(inside.all())
