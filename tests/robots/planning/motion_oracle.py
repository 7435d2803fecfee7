"""An independent judge of planned motions: MuJoCo's contacts of the simulated arm, in fine steps.

It shares no shape, distance, step or pair list with the planners: bodies are those of the simulator, and MuJoCo finds
what touches. Only the scene that was asked for is read.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from itertools import pairwise
from typing import Any

import numpy as np

from engine.messages import Pose
from engine.messages.pose_algebra import compose_poses
from engine.messages.shapes import Box, Capsule, Cylinder, Shape, Sphere
from robots.planning.scene.planning_scene import AttachedPart, PlanningScene
from robots.port import Array
from robots.sim.physics.arm_spec import arm_spec
from robots.sim.physics.physics import mujoco

_CORNERS = np.array([(x, y, z) for x in (-1.0, 1.0) for y in (-1.0, 1.0) for z in (-1.0, 1.0)])
STEP_RAD = 0.004
"""The joints turn by at most this much in sum between two configurations: 4 mm at a reach of 1 m."""
TOLERANCE_M = 2e-3
"""Difference between the shapes of the simulator and those of the planners, and of their distances."""


@dataclass(frozen=True, kw_only=True)
class Touch:
    """Two bodies nearer than allowed, at one configuration of a motion."""

    index: int
    bodies: tuple[str, str]
    distance_m: float


class MotionOracle:
    """One arm of a planning scene in MuJoCo, the other arms where the scene has them."""

    def __init__(self, scene: PlanningScene, arm: str, *, margin_m: float = 0.0) -> None:
        self._scene = scene
        self._arm = arm
        self._margin_m = margin_m
        self._held = {part.name for part in scene.attached}
        spec = mujoco.MjSpec()
        spec.compiler.degree = False
        for each in scene.arms:
            base = each.placement.base
            frame = spec.worldbody.add_frame(pos=list(base.xyz), quat=_wxyz(base))
            spec.attach(arm_spec(each.placement.robot()), frame=frame, prefix=f"{each.name}/")
        for part in scene.attached:
            model = scene.arm(part.arm).placement.robot()
            _add_part(spec.body(f"{part.arm}/{part.link or model.tool_link}"), part)
        for obstacle in scene.obstacles:
            body = spec.worldbody.add_body(name=obstacle.name, pos=list(obstacle.pose.xyz), quat=_wxyz(obstacle.pose))
            for solid in obstacle.solids:
                _add_shape(body, solid.shape, solid.pose).margin = margin_m
        self._model = spec.compile()
        self._data = mujoco.MjData(self._model)
        for each in scene.arms:
            robot = each.placement.robot()
            for name, value in zip(robot.arm_joints, each.joints_rad or robot.home_rad, strict=True):
                self._set(f"{each.name}/{name}", value)
            for name, value in each.tool_joints:
                self._set(f"{each.name}/{name}", value)
        joints = scene.arm(arm).placement.robot().arm_joints
        self._qpos = [int(self._model.joint(f"{arm}/{name}").qposadr[0]) for name in joints]

    def first_touch(self, path: Array) -> Touch | None:
        """Return the first contact, or approach within the margin, on straight joint lines; None if there is none."""
        for index, joints in enumerate(fine_steps(path)):
            touches = self.touches(joints, index=index)
            if touches:
                return touches[0]
        return None

    def touches(self, joints: Array, *, index: int = 0) -> list[Touch]:
        """Return what touches at a configuration, or is within the margin, with the deepest first."""
        self._data.qpos[self._qpos] = joints
        mujoco.mj_kinematics(self._model, self._data)
        mujoco.mj_comPos(self._model, self._data)
        mujoco.mj_collision(self._model, self._data)
        found: list[Touch] = []
        for contact in self._data.contact[: self._data.ncon]:
            first, second = (self._name(int(geom)) for geom in contact.geom)
            own = self._is_own(first) and self._is_own(second)
            nearest_m = (0.0 if own else self._margin_m) - TOLERANCE_M
            if contact.dist < nearest_m and not self._may_touch(first, second):
                found.append(Touch(index=index, bodies=(first, second), distance_m=float(contact.dist)))
        return sorted(found, key=lambda touch: touch.distance_m)

    def corners(self, joints: Array) -> Array:
        """Return the corners of the boxes around the bodies of the arm at a configuration, shape (k, 3)."""
        self.touches(joints)
        found: list[Array] = []
        for geom in range(self._model.ngeom):
            if self._is_own(self._name(geom)):
                box = self._model.geom_aabb[geom]
                points = box[:3] + _CORNERS * box[3:]
                found.append(points @ self._data.geom_xmat[geom].reshape(3, 3).T + self._data.geom_xpos[geom])
        return np.vstack(found)

    def outermost(self, joints: Array) -> Array:
        """Return the middle of the body of the arm that is farthest from its first axis, shape (3,)."""
        self.touches(joints)
        own = [geom for geom in range(self._model.ngeom) if self._is_own(self._name(geom))]
        middles = [np.array(self._data.geom_xpos[geom]) for geom in own]
        return max(middles, key=lambda at: math.hypot(at[0], at[1]))

    def gap_m(self, joints: Array) -> float:
        """Return the smallest distance of what is within the margin, at a configuration; infinite beyond it."""
        self.touches(joints)
        gaps = [
            float(contact.dist)
            for contact in self._data.contact[: self._data.ncon]
            if not all(self._is_own(self._name(int(geom))) for geom in contact.geom)
        ]
        return min(gaps, default=math.inf)

    def _may_touch(self, first: str, second: str) -> bool:
        others = {first, second} - {each for each in (first, second) if self._is_own(each)}
        if not {first, second} - others:
            return True  # other arms among themselves
        if first in self._held and second in self._held:
            return True
        return self._scene.may_touch(first, second)

    def _is_own(self, name: str) -> bool:
        return name.startswith(f"{self._arm}/") or any(
            part.name == name and part.arm == self._arm for part in self._scene.attached
        )

    def _name(self, geom: int) -> str:
        name = str(self._model.geom(geom).name)
        part = name.partition("#")[0]
        return part if part in self._held else str(self._model.body(int(self._model.geom_bodyid[geom])).name)

    def _set(self, joint: str, value: float) -> None:
        self._data.qpos[int(self._model.joint(joint).qposadr[0])] = value


def fine_steps(path: Array) -> Array:
    """Return the configurations of straight joint lines, (k, n), at most `STEP_RAD` apart in sum."""
    rows = [path[:1]]
    for before, after in pairwise(path):
        count = max(1, math.ceil(float(np.abs(after - before).sum()) / STEP_RAD))
        rows.append(before + np.linspace(0.0, 1.0, count + 1)[1:, None] * (after - before))
    return np.vstack(rows)


def _add_part(body: Any, part: AttachedPart) -> None:
    for number, solid in enumerate(part.solids):
        geom = _add_shape(body, solid.shape, compose_poses(part.pose, solid.pose))
        geom.name = f"{part.name}#{number}"
        geom.mass = 1e-6


def _add_shape(body: Any, shape: Shape, pose: Pose) -> Any:
    at = {"pos": list(pose.xyz), "quat": _wxyz(pose)}
    kinds = mujoco.mjtGeom
    match shape:
        case Box(size_m=size):
            return body.add_geom(type=kinds.mjGEOM_BOX, size=[edge / 2 for edge in size], **at)
        case Cylinder(radius_m=radius, length_m=length):
            return body.add_geom(type=kinds.mjGEOM_CYLINDER, size=[radius, length / 2, 0.0], **at)
        case Sphere(radius_m=radius):
            return body.add_geom(type=kinds.mjGEOM_SPHERE, size=[radius, 0.0, 0.0], **at)
        case Capsule(radius_m=radius, length_m=length):
            return body.add_geom(type=kinds.mjGEOM_CAPSULE, size=[radius, length / 2, 0.0], **at)
        case _:
            raise TypeError(f"the oracle has no {type(shape).__name__}")


def _wxyz(pose: Pose) -> list[float]:
    x, y, z, w = pose.xyzw
    return [w, x, y, z]
