"""Tools in MuJoCo's specification: the bodies at their plates, and a coupling to each tool changer."""

from __future__ import annotations

from typing import Any

from engine.document import ToolShape
from robots.model.folder.master_plate import MASTER_FACE
from robots.scene.sim_scene import SimScene
from robots.sim.physics.physics import mujoco
from robots.sim.physics.tool_body import ROD_SOLIMP, ROD_SOLREF


def coupling_name(arm: str, tool: str) -> str:
    """Return the name of the constraint between the master plate of an arm and a tool."""
    return f"{arm}/{tool}/coupling"


def add_couplings(spec: Any, scene: SimScene) -> None:
    """Add an inactive constraint for each master plate and tool, that holds the faces of their plates together."""
    for arm in scene.arms:
        if arm.tool_changer is None:
            continue
        for part in scene.parts:
            if part.tool is None:
                continue
            coupling = spec.add_equality(
                name=coupling_name(arm.name, part.name),
                type=mujoco.mjtEq.mjEQ_WELD,
                objtype=mujoco.mjtObj.mjOBJ_BODY,
                name1=f"{arm.name}/{MASTER_FACE}",
                name2=part.name,
                active=False,
                solref=list(ROD_SOLREF),
                solimp=list(ROD_SOLIMP),
            )
            # Anchor in the tool, then the pose of the tool in the face, then the weight of rotations.
            pose = [0.0, 0.0, part.face_m, 1.0, 0.0, 0.0, 0.0]
            coupling.data[:11] = [0.0, 0.0, 0.0, *pose, 1.0]


def place_shape(geom: Any, shape: ToolShape, *, mass_factor: float) -> None:
    """Put a body of a tool where it is at the plate, with its mass."""
    pose = shape.at.pose()
    x, y, z, w = pose.xyzw
    geom.pos, geom.quat = list(pose.xyz), [w, x, y, z]
    geom.mass = shape.mass_kg * mass_factor
