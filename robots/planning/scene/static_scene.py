"""The static objects while one arm of a scene moves: obstacles, and the other arms with their attached parts."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import msgspec
import numpy as np

from engine.errors import CellError
from engine.messages.shapes import Shape
from robots.model.robot_model import RobotModel
from robots.model.transform import RigidTransform
from robots.planning.scene.arm_shapes import arm_shapes
from robots.planning.scene.coal_shapes import pin, rigid_of
from robots.planning.scene.planning_scene import AttachedPart, PlanningScene, SceneArm
from robots.planning.scene.shape_cache import CachedShape, cached_link_shapes, cached_shape
from robots.port import Array
from robots.scene.sim_scene import ArmPlacement


@dataclass(frozen=True, kw_only=True)
class PlacedSolid:
    """A convex shape at its pose in the world, with the name that allowed pairs and reports use."""

    name: str
    ready: CachedShape
    pose: RigidTransform

    @property
    def shape(self) -> Shape:
        """The shape as data."""
        return self.ready.shape


@dataclass(frozen=True, kw_only=True)
class ArmInScene:
    """One arm of a scene and everything else in it: the input of both checkers."""

    scene: PlanningScene
    placed: SceneArm
    model: RobotModel
    held: tuple[AttachedPart, ...]
    outside: tuple[PlacedSolid, ...]

    @property
    def name(self) -> str:
        """The arm's name in the cell."""
        return self.placed.name


def arm_in_scene(
    scene: PlanningScene, arm: str, *, robot: Callable[[ArmPlacement], RobotModel] = ArmPlacement.robot
) -> ArmInScene:
    """Return an arm of a scene and the static rest; `robot` loads models.

    Raises:
        CellError: there is no such arm, a model or a shape is invalid, or the number of joints of an arm is wrong.
    """
    placed = scene.arm(arm)
    return ArmInScene(
        scene=scene,
        placed=placed,
        model=robot(placed.placement),
        held=tuple(part for part in scene.attached if part.arm == arm),
        outside=static_solids(scene, arm, robot=robot),
    )


def static_solids(
    scene: PlanningScene, arm: str, *, robot: Callable[[ArmPlacement], RobotModel] = ArmPlacement.robot
) -> tuple[PlacedSolid, ...]:
    """Return everything in the scene that is neither `arm` nor held by it.

    Raises:
        CellError: a model or a shape is invalid, or the number of joints of an arm is wrong.
    """
    solids = [
        PlacedSolid(
            name=obstacle.name,
            ready=cached_shape(solid.shape, obstacle.name),
            pose=RigidTransform.from_pose(obstacle.pose).then(RigidTransform.from_pose(solid.pose)),
        )
        for obstacle in scene.obstacles
        for solid in obstacle.solids
    ]
    for other in scene.arms:
        if other.name != arm:
            held = tuple(part for part in scene.attached if part.arm == other.name)
            solids.extend(_arm_solids(other, robot(other.placement), held))
    return tuple(solids)


def joints_of(arm: SceneArm, model: RobotModel) -> Array:
    """Return an arm's joints, shape (n,); raises CellError if their number is wrong."""
    joints = np.array(arm.joints_rad or model.home_rad, dtype=np.float64)
    if joints.shape != (model.dof,):
        raise CellError(f"got {len(joints)} joints", where=arm.name, hint=f"this arm has {model.dof}")
    return joints


def held_frame(model: RobotModel, solver: Any, part: AttachedPart) -> Any:
    """Return the frame of Pinocchio's model of the arm to which a held part is attached.

    Raises:
        CellError: the arm has no such link.
    """
    link = part.link or model.tool_link
    if not solver.existFrame(link):
        raise CellError(f"the arm has no link {link}", where=part.name, hint="name a link of the URDF")
    return solver.frames[solver.getFrameId(link)]


def tool_joint(model: RobotModel, solver: Any) -> int:
    """Return the number of the joint of Pinocchio's model of an arm with which the tool link moves."""
    return int(solver.frames[solver.getFrameId(model.tool_link)].parentJoint)


def with_tool_contact(
    scene: PlanningScene, arm: str, *, robot: Callable[[ArmPlacement], RobotModel] = ArmPlacement.robot
) -> PlanningScene:
    """Return the scene in which the tool of an arm, and what it holds, may touch every obstacle."""
    placed = scene.arm(arm)
    model = robot(placed.placement)
    shapes = arm_shapes(model, placed.tool_joints)
    joint = tool_joint(model, shapes.solver)
    links = zip(shapes.links, shapes.geometry.geometryObjects, strict=True)
    bodies = [f"{arm}/{link}" for link, shape in links if shape.parentJoint == joint]
    bodies += [part.name for part in scene.attached if part.arm == arm]
    pairs = tuple((body, one.name) for body in dict.fromkeys(bodies) for one in scene.obstacles)
    return msgspec.structs.replace(scene, allowed=(*scene.allowed, *pairs))


def _arm_solids(arm: SceneArm, model: RobotModel, held: tuple[AttachedPart, ...]) -> list[PlacedSolid]:
    shapes = arm_shapes(model, arm.tool_joints)
    base = RigidTransform.from_pose(arm.placement.base)
    data = shapes.solver.createData()
    pin.forwardKinematics(shapes.solver, data, joints_of(arm, model))
    solids = [
        PlacedSolid(
            name=f"{arm.name}/{link}",
            ready=ready,
            pose=base.then(rigid_of(data.oMi[shape.parentJoint] * shape.placement)),
        )
        for link, shape, ready in zip(
            shapes.links,
            shapes.geometry.geometryObjects,
            cached_link_shapes(model, arm.tool_joints),
            strict=True,
        )
    ]
    for part in held:
        frame = held_frame(model, shapes.solver, part)
        at = base.then(rigid_of(data.oMi[frame.parentJoint] * frame.placement)).then(
            RigidTransform.from_pose(part.pose)
        )
        solids.extend(
            PlacedSolid(
                name=part.name,
                ready=cached_shape(solid.shape, part.name),
                pose=at.then(RigidTransform.from_pose(solid.pose)),
            )
            for solid in part.solids
        )
    return solids
