"""Array indices of a tool's joints, motors, pads and fingers in a compiled world."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from robots.model.tool_model import ClawModel, GripperModel, LinkageModel, MagnetModel, SynergyModel, ToolModel
from robots.port import Array
from robots.sim.physics.opening_table import OpeningTable, read_openings
from robots.sim.physics.tool_spec import FACE, TENDON, pad_geom_name

Indices = NDArray[np.intp]


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


@dataclass(frozen=True, kw_only=True)
class HandIndices:
    """Addresses of a soft hand; `places` are the bodies of each finger, thumb first, and last the palm's."""

    model: SynergyModel
    qpos: Indices
    tendon: int
    motor: int
    places: tuple[frozenset[int], ...]
    home: Array


@dataclass(frozen=True, kw_only=True)
class MagnetIndices:
    """Addresses of a magnet: its body, the geometry of its face, and those of the parts that it attracts."""

    model: MagnetModel
    qpos: Indices
    body: int
    face: int
    ferrous: tuple[int, ...]
    home: Array


ToolIndices = FingerIndices | LinkageIndices | HandIndices | MagnetIndices


def tool_indices(model: Any, arm: str, tool: ToolModel, *, ferrous: Iterable[str]) -> ToolIndices:
    """Return the indices of an arm's tool in a compiled model; `ferrous` are the parts that magnets attract."""

    def qpos(joints: Iterable[str]) -> Indices:
        return _ints(model.joint(f"{arm}/{joint}").qposadr[0] for joint in joints)

    def dof(joints: Iterable[str]) -> Indices:
        return _ints(model.joint(f"{arm}/{joint}").dofadr[0] for joint in joints)

    match tool.mechanism:
        case GripperModel() as gripper:
            joints = gripper.finger_joints
            return FingerIndices(
                model=gripper,
                qpos=qpos(joints),
                dof=dof(joints),
                motor=_ints(model.actuator(f"{arm}/{joint}").id for joint in joints),
                pad_geoms=_pads(model, arm, gripper),
                home=np.full(2, gripper.max_width_m / 2),
            )
        case LinkageModel() | ClawModel() as linkage:
            joints = (linkage.driver, *(name for name, _ in linkage.followers))
            factors = np.array([1.0, *(factor for _, factor in linkage.followers)])
            pads = _pads(model, arm, linkage)
            places = qpos(joints)
            return LinkageIndices(
                model=linkage,
                qpos=places,
                dof=dof(joints),
                factors=factors,
                motor=int(model.actuator(f"{arm}/{linkage.driver}").id),
                pad_geoms=pads,
                openings=read_openings(
                    model,
                    qpos=places,
                    factors=factors,
                    pads=pads,
                    first_rad=linkage.open_rad,
                    last_rad=linkage.closed_rad,
                ),
                home=factors * linkage.open_rad,
            )
        case SynergyModel() as hand:
            joints = [joint.name for joint in (*hand.flexion, *hand.passive)]
            places = [*hand.fingers, (hand.palm_link,)]
            return HandIndices(
                model=hand,
                qpos=qpos(joints),
                tendon=int(model.tendon(f"{arm}/{TENDON}").id),
                motor=int(model.actuator(f"{arm}/{TENDON}").id),
                places=tuple(frozenset(int(model.body(f"{arm}/{link}").id) for link in place) for place in places),
                home=np.zeros(len(joints)),
            )
        case MagnetModel() as magnet:
            return MagnetIndices(
                model=magnet,
                qpos=_ints(()),
                body=int(model.body(f"{arm}/{magnet.face.link}").id),
                face=int(model.geom(f"{arm}/{FACE}").id),
                ferrous=tuple(int(model.geom(part).id) for part in ferrous),
                home=np.zeros(0),
            )


def _pads(model: Any, arm: str, tool: GripperModel | LinkageModel | ClawModel) -> tuple[int, int]:
    left, right = (int(model.geom(f"{arm}/{pad_geom_name(pad)}").id) for pad in tool.pads)
    return left, right


def _ints(values: Iterable[Any]) -> Indices:
    return np.array([int(value) for value in values], dtype=np.intp)
