"""RoboPlan's RRT-Connect with its shortcutter on our scenes: the same URDF, solids and allowed pairs, tool locked."""

from __future__ import annotations

import xml.etree.ElementTree as ET
from importlib import import_module
from typing import Any

import numpy as np

from benchmarks.planning_scenes import ARM
from engine.errors import CellError
from engine.messages.shapes import Box, Cylinder, Sphere
from robots.model.transform import RigidTransform
from robots.planning.request import JointGoal, PlanRequest
from robots.planning.scene.arm_shapes import arm_shapes
from robots.planning.scene.planning_scene import PlanningScene
from robots.planning.scene.static_scene import static_solids
from robots.port import Array

_STEP_RAD = 0.05


class RoboplanPlanner:
    """One scene, prepared; only for one arm with boxes, cylinders and spheres.

    Raises:
        ModuleNotFoundError: RoboPlan is not installed.
        CellError: the scene has another shape.
    """

    def __init__(self, scene: PlanningScene) -> None:
        self._core: Any = import_module("roboplan.core")
        self._rrt: Any = import_module("roboplan.rrt")
        model = scene.arms[0].placement.robot()
        description = self._core.loadUrdfSceneDescriptionFromXml(
            _locked(model.urdf_text, model.arm_joints), model.package_dirs
        )
        self._scene: Any = self._core.Scene("scene", description)
        self._joints = list(model.arm_joints)
        self._scene.addGroup("arm", self._joints)
        self._add_solids(scene)
        self._allow(scene, {frozenset(pair) for pair in arm_shapes(model, ()).pairs})

    def plan(self, request: PlanRequest, *, seed: int, time_s: float) -> Array | None:
        """Return a shortened way, None when none was found in time; nothing else confirms it."""
        assert isinstance(request.goal, JointGoal)
        options = self._rrt.RRTOptions(
            group_name="arm",
            max_nodes=20_000,
            collision_check_step_size=_STEP_RAD,
            max_planning_time=time_s,
            rrt_connect=True,
        )
        planner = self._rrt.RRT(self._scene, options)
        planner.setRngSeed(seed)
        ends = [
            self._core.JointConfiguration(self._joints, np.array(joints, dtype=np.float64))
            for joints in (request.start_rad, request.goal.joints_rad[0])
        ]
        try:
            path = planner.plan(*ends)
        except RuntimeError:
            return None
        shortening = self._core.PathShortcuttingOptions(group_name="arm", max_step_size=_STEP_RAD, seed=seed)
        shorter = self._core.PathShortcutter(self._scene, shortening).shortcut(path)
        return np.array(shorter.positions, dtype=np.float64)

    def _add_solids(self, scene: PlanningScene) -> None:
        colour = np.ones(4)
        self._solids: dict[str, str] = {}
        for index, solid in enumerate(static_solids(scene, ARM)):
            at = np.eye(4)
            pose: RigidTransform = solid.pose
            at[:3, :3], at[:3, 3] = pose.rotation, pose.xyz
            name = f"solid_{index}"
            self._solids[name] = solid.name
            match solid.shape:
                case Box(size_m=size):
                    self._scene.addBoxGeometry(name, "universe", self._core.Box(*size), np.asfortranarray(at), colour)
                case Cylinder(radius_m=radius, length_m=length):
                    shape = self._core.Cylinder(radius, length)
                    self._scene.addCylinderGeometry(name, "universe", shape, np.asfortranarray(at), colour)
                case Sphere(radius_m=radius):
                    shape = self._core.Sphere(radius)
                    self._scene.addSphereGeometry(name, "universe", shape, np.asfortranarray(at), colour)
                case _:
                    raise CellError("this comparison has no such shape", where=solid.name)

    def _allow(self, scene: PlanningScene, checked: set[frozenset[str]]) -> None:
        """Switch off what we do not look at: obstacles among themselves, the base, allowed pairs."""
        model = scene.arms[0].placement.robot()
        shapes = arm_shapes(model, ())
        moving = {
            link
            for link, shape in zip(shapes.links, shapes.geometry.geometryObjects, strict=True)
            if shape.parentJoint > 0
        }
        links = sorted(set(shapes.links))
        off = [(a, b) for a in links for b in links if a < b and frozenset((a, b)) not in checked]
        names = list(self._solids)
        off += [(a, b) for i, a in enumerate(names) for b in names[:i]]
        for name, ours in self._solids.items():
            off += [(link, name) for link in links if link not in moving or scene.may_touch(f"{ARM}/{link}", ours)]
        self._scene.setCollisions(off, False)


def _locked(urdf: str, joints: tuple[str, ...]) -> str:
    """Return the URDF with all joints but the arm's fixed."""
    robot = ET.fromstring(urdf)
    for joint in robot.iter("joint"):
        if joint.get("name") not in joints:
            joint.set("type", "fixed")
            for element in joint.findall("mimic") + joint.findall("limit"):
                joint.remove(element)
    return ET.tostring(robot, encoding="unicode")
