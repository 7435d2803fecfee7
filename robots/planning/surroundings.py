"""What stands still while one arm of a scene moves: obstacles, and the other arms with what they hold."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from engine.errors import CellError
from engine.shapes import Shape
from robots.model.rigid import Rigid
from robots.model.robot_model import RobotModel
from robots.planning.arm_shapes import arm_shapes
from robots.planning.coal_shapes import pin, rigid_of, shape_of
from robots.planning.scene import AttachedPart, PlanningScene, SceneArm
from robots.port import Array


@dataclass(frozen=True, kw_only=True)
class PlacedSolid:
    """A convex shape where it stands in the world, under the name that allowed pairs and reports use."""

    name: str
    shape: Shape
    pose: Rigid


def surroundings(scene: PlanningScene, arm: str) -> tuple[PlacedSolid, ...]:
    """Return everything in the scene that is neither `arm` nor held by it.

    Raises:
        CellError: an arm's model cannot be loaded, or its joints are not as many as it has.
    """
    found = [
        PlacedSolid(
            name=obstacle.name,
            shape=solid.shape,
            pose=Rigid.from_pose(obstacle.pose).then(Rigid.from_pose(solid.pose)),
        )
        for obstacle in scene.obstacles
        for solid in obstacle.solids
    ]
    for other in scene.arms:
        if other.name != arm:
            held = tuple(part for part in scene.attached if part.arm == other.name)
            found.extend(_arm_solids(other, held))
    return tuple(found)


def joints_of(arm: SceneArm, model: RobotModel) -> Array:
    """Return where an arm's joints are, shape (n,); raises CellError when they are not as many as it has."""
    joints = np.array(arm.joints_rad if arm.joints_rad else model.home_rad, dtype=np.float64)
    if joints.shape != (model.dof,):
        raise CellError(f"{len(joints)} joints are given", where=arm.name, hint=f"this arm has {model.dof}")
    return joints


def held_frame(model: RobotModel, solver: Any, part: AttachedPart) -> Any:
    """Return the frame, of pinocchio's model of the arm, that a held part is attached to.

    Raises:
        CellError: the arm has no such link.
    """
    link = part.link or model.tool_link
    if not solver.existFrame(link):
        raise CellError(f"the arm has no link {link}", where=part.name, hint="name a link of the URDF")
    return solver.frames[solver.getFrameId(link)]


def _arm_solids(arm: SceneArm, held: tuple[AttachedPart, ...]) -> list[PlacedSolid]:
    model = arm.placement.robot()
    shapes = arm_shapes(model, arm.tool_joints)
    base = Rigid.from_pose(arm.placement.base)
    data = shapes.solver.createData()
    pin.forwardKinematics(shapes.solver, data, joints_of(arm, model))
    found = [
        PlacedSolid(
            name=f"{arm.name}/{link}",
            shape=shape_of(shape.geometry),
            pose=base.then(rigid_of(data.oMi[shape.parentJoint] * shape.placement)),
        )
        for link, shape in zip(shapes.links, shapes.geometry.geometryObjects, strict=False)
    ]
    for part in held:
        frame = held_frame(model, shapes.solver, part)
        at = base.then(rigid_of(data.oMi[frame.parentJoint] * frame.placement)).then(Rigid.from_pose(part.pose))
        found.extend(
            PlacedSolid(name=part.name, shape=solid.shape, pose=at.then(Rigid.from_pose(solid.pose)))
            for solid in part.solids
        )
    return found
