"""The body of a soft hand in the world: tendon, motor, springs, skin, and their addresses."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from robots.model.hand_mechanism import SynergyModel
from robots.model.tool_model import ToolModel
from robots.port import Array
from robots.sim.physics.physics import mujoco
from robots.sim.physics.tool_body import PAD_SOLIMP, PAD_SOLREF, ROD_SOLREF, Indices, as_indices

_SKIN_FRICTION = (1.0, 0.01, 0.0005)
_PHALANX_ARMATURE_KG_M2 = 2e-5
_TENDON = "tendon"


@dataclass(frozen=True, kw_only=True)
class HandIndices:
    """Addresses of a soft hand; `places` are the bodies of each finger, thumb first, and last the palm's."""

    model: SynergyModel
    qpos: Indices
    tendon: int
    motor: int
    places: tuple[frozenset[int], ...]
    home: Array


def finish_hand(spec: Any, tool: ToolModel, hand: SynergyModel) -> None:
    """Add the tendon, its motor and the skin of a soft hand."""
    tendon = spec.add_tendon(name=_TENDON)
    for flexed in (*hand.flexion, *hand.passive):
        joint = spec.joint(flexed.name)
        joint.stiffness[0] = flexed.stiffness_nm_rad
        joint.damping[0] = flexed.damping_nms_rad
        joint.springref = 0.0
        joint.armature = _PHALANX_ARMATURE_KG_M2
        joint.solref_limit = list(ROD_SOLREF)
        if flexed.radius_m:
            tendon.wrap_joint(flexed.name, flexed.radius_m)
    motor = spec.add_actuator(name=_TENDON, target=_TENDON, trntype=mujoco.mjtTrn.mjTRN_TENDON)
    motor.set_to_motor()
    motor.ctrllimited = True
    motor.ctrlrange = [0.0, hand.max_force_n]
    for link in tool.links:
        for geom in spec.body(link).geoms:
            geom.condim, geom.priority = 4, 1
            geom.friction = list(_SKIN_FRICTION)
            geom.solref, geom.solimp = list(PAD_SOLREF), list(PAD_SOLIMP)


def hand_indices(model: Any, arm: str, hand: SynergyModel) -> HandIndices:
    """Return the addresses of a soft hand on an arm."""
    joints = hand.joint_names()
    places = (*hand.fingers, (hand.palm_link,))
    return HandIndices(
        model=hand,
        qpos=as_indices(model.joint(f"{arm}/{joint}").qposadr[0] for joint in joints),
        tendon=int(model.tendon(f"{arm}/{_TENDON}").id),
        motor=int(model.actuator(f"{arm}/{_TENDON}").id),
        places=tuple(frozenset(int(model.body(f"{arm}/{link}").id) for link in place) for place in places),
        home=np.zeros(len(joints)),
    )
