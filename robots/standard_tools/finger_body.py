"""The bodies of two-finger grippers in the world: motors, pads, and their addresses."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from robots.model.finger_mechanisms import ClawModel, GripperModel, LinkageModel
from robots.model.mechanism import PadBox
from robots.port import Array
from robots.sim.physics.opening_table import OpeningTable, read_openings
from robots.sim.physics.physics import mujoco
from robots.sim.physics.tool_body import ROD_SOLIMP, ROD_SOLREF, Indices, add_box, add_motor, as_indices

# Rubber that measured best for holding without slip: stiff, elliptic, torsional friction.
_PAD_FRICTION = (0.8, 0.005, 0.0001)


@dataclass(frozen=True, kw_only=True)
class FingerIndices:
    """Addresses of two sliding fingers, left then right."""

    model: GripperModel
    qpos: Indices
    dof: Indices
    motor: Indices
    pad_geoms: tuple[int, int]
    home: Array


@dataclass(frozen=True, kw_only=True)
class LinkageIndices:
    """Addresses of a linkage: the motor's joint first, then its followers, which turn by `factors` of it."""

    model: LinkageModel | ClawModel
    qpos: Indices
    dof: Indices
    factors: Array
    motor: int
    pad_geoms: tuple[int, int]
    openings: OpeningTable
    home: Array


def finish_fingers(spec: Any, gripper: GripperModel) -> None:
    """Add a motor and a pad to each of two sliding fingers."""
    for name in gripper.finger_joints:
        joint = spec.joint(name)
        joint.armature = gripper.armature_kg
        joint.actfrclimited = mujoco.mjtLimited.mjLIMITED_FALSE
        add_motor(spec, name, gripper.max_force_n)
    for pad in gripper.pads:
        _add_pad(spec, pad)


def finish_linkage(spec: Any, linkage: LinkageModel | ClawModel) -> None:
    """Add the motor and the pads of fingers that turn."""
    factors = {linkage.driver: 1.0, **linkage.followers}
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
            equality.solref = list(ROD_SOLREF)
            equality.solimp = list(ROD_SOLIMP)
    for pad in linkage.pads:
        _add_pad(spec, pad)


def finger_indices(model: Any, arm: str, gripper: GripperModel) -> FingerIndices:
    """Return the addresses of two sliding fingers on an arm."""
    joints = [f"{arm}/{joint}" for joint in gripper.finger_joints]
    return FingerIndices(
        model=gripper,
        qpos=_qpos(model, joints),
        dof=_dof(model, joints),
        motor=as_indices(model.actuator(joint).id for joint in joints),
        pad_geoms=_pads(model, arm, gripper),
        home=np.full(2, gripper.max_width_m / 2),
    )


def linkage_indices(model: Any, arm: str, linkage: LinkageModel | ClawModel) -> LinkageIndices:
    """Return the addresses of fingers that turn, on an arm, with the opening by the angle of the motor."""
    joints = [f"{arm}/{joint}" for joint in linkage.joint_names()]
    factors = np.array([1.0, *linkage.followers.values()])
    pads, places = _pads(model, arm, linkage), _qpos(model, joints)
    return LinkageIndices(
        model=linkage,
        qpos=places,
        dof=_dof(model, joints),
        factors=factors,
        motor=int(model.actuator(joints[0]).id),
        pad_geoms=pads,
        openings=read_openings(
            model, qpos=places, factors=factors, pads=pads, first_rad=linkage.open_rad, last_rad=linkage.closed_rad
        ),
        home=factors * linkage.open_rad,
    )


def _qpos(model: Any, joints: Sequence[str]) -> Indices:
    return as_indices(model.joint(joint).qposadr[0] for joint in joints)


def _dof(model: Any, joints: Sequence[str]) -> Indices:
    return as_indices(model.joint(joint).dofadr[0] for joint in joints)


def _pads(model: Any, arm: str, tool: GripperModel | LinkageModel | ClawModel) -> tuple[int, int]:
    left, right = (int(model.geom(f"{arm}/{_pad_geom(pad)}").id) for pad in tool.pads)
    return left, right


def _add_pad(spec: Any, pad: PadBox) -> None:
    body = spec.body(pad.link)
    for geom in list(body.geoms):
        if _is_the_described_tip(geom, pad):
            spec.delete(geom)
    add_box(spec, pad, name=_pad_geom(pad), friction=_PAD_FRICTION)


def _pad_geom(pad: PadBox) -> str:
    """Return the name of a pad's collision geometry before prefixing."""
    return f"{pad.link}_pad"


def _is_the_described_tip(geom: Any, pad: PadBox) -> bool:
    inside = np.abs(np.asarray(geom.pos) - np.asarray(pad.xyz)) < np.asarray(pad.size_m) / 2
    return bool(inside.all())
