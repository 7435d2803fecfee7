"""What there is to see in the fake cell beside its bodies: ways, obstacles, voxels, a camera, detections, a person."""

from __future__ import annotations

import math
from typing import Literal

import msgspec
import numpy as np

from engine.messages import FramePoses, Pose, RobotDescription, SceneDescription, Vector3, VisualGeometry
from engine.messages.sensing import CameraInfo, CameraIntrinsics, DepthImage, OccupancyGrid, OccupancyState
from engine.messages.shapes import Box, Capsule, Cylinder, Hull, Obstacle, Shape, Solid, Sphere
from engine.skills.planning import PathPreview
from engine.skills.planning_scene import HeldPart, PlanningSceneState
from engine.skills.vision import Detection, Detections
from tests.editor_web.fake_scene import frames_at, new_scene

JOINTS: tuple[str, ...] = ("yaw", "lean", "elbow")
ARMS = {"left": (-0.55, 1.0), "right": (0.55, -1.0)}
URDF = """
<robot name="swing">
  <link name="foot"/><link name="base"/><link name="upper"/><link name="fore"/><link name="tool"/>
  <joint name="tip" type="fixed"><parent link="fore"/><child link="tool"/><origin xyz="0 0 0.4"/></joint>
  <joint name="elbow" type="revolute">
    <parent link="upper"/><child link="fore"/><origin xyz="0 0 0.4"/><axis xyz="0 1 0"/>
  </joint>
  <joint name="lean" type="revolute">
    <parent link="base"/><child link="upper"/><origin xyz="0 0 0.2" rpy="0 0 0"/><axis xyz="0 2 0"/>
  </joint>
  <joint name="yaw" type="continuous"><parent link="foot"/><child link="base"/><axis xyz="0 0 1"/></joint>
</robot>
"""
LENS = CameraIntrinsics(width_px=320, height_px=240, fx_px=280.0, fy_px=280.0, cx_px=159.5, cy_px=119.5)
# From above and behind, looking down on the table.
CAMERA_POSE = Pose(xyz=(0.0, -0.95, 0.85), xyzw=(-0.8924, 0.0, 0.0, 0.4512))


def joints_at(arm: str, time_s: float) -> tuple[float, ...]:
    """The joints of which `frames_at` has the frames."""
    sign = ARMS[arm][1]
    return (0.5 * math.sin(1.5 * time_s + sign), sign * (0.5 + 0.2 * math.sin(2.0 * time_s)), sign * 1.5)


def description(arm: str) -> RobotDescription:
    """What an arm says of itself."""
    three = (1.0, 1.0, 1.0)
    return RobotDescription(
        name=arm,
        model="swing",
        urdf=URDF,
        joint_names=JOINTS,
        lower_rad=three,
        upper_rad=three,
        velocity_rad_s=three,
        acceleration_rad_s2=three,
        base=Pose(xyz=(ARMS[arm][0], 0.0, 0.0)),
        tool_frame=f"{arm}/tool",
    )


def tool_at(arm: str, joints: tuple[float, ...]) -> Vector3:
    """The tip of the arm."""
    yaw, lean, elbow = joints
    out = 0.4 * math.sin(lean) + 0.4 * math.sin(lean + elbow)
    up = 0.2 + 0.4 * math.cos(lean) + 0.4 * math.cos(lean + elbow)
    return (ARMS[arm][0] + out * math.cos(yaw), out * math.sin(yaw), up)


def planned_path(
    arm: str, state: Literal["none", "proposed", "moving", "blocked"] = "proposed", *, reason: str = ""
) -> PathPreview:
    """A swing over the table."""
    if state == "none":
        return PathPreview(robot=arm, state="none")
    sign = ARMS[arm][1]
    rows = tuple(
        (1.1 - 2.2 * s, sign * (0.55 - 0.45 * math.sin(math.pi * s)), sign * 1.3)
        for s in (step / 24 for step in range(25))
    )
    path = tuple(tool_at(arm, row) for row in rows)
    return PathPreview(robot=arm, state=state, joint_names=JOINTS, joints=rows, tool_path=path, reason=reason)


def scene_with_a_person() -> SceneDescription:
    """The fake cell, and an arm of somebody."""
    skin = (0.85, 0.63, 0.4, 1.0)
    arm = VisualGeometry(name="anna/fore/rod", frame="anna/fore", kind="cylinder", size_m=(0.04, 0.36), rgba=skin)
    hand = VisualGeometry(name="anna/hand/ball", frame="anna/hand", kind="sphere", size_m=(0.05,), rgba=skin)
    return SceneDescription(geometries=(*new_scene().geometries, arm, hand))


def frames_with_a_person(time_s: float) -> FramePoses:
    """The arms as they swing; the person rests."""
    frames = frames_at(time_s)
    lying = (math.sqrt(0.5), 0.0, 0.0, math.sqrt(0.5))
    return msgspec.structs.replace(
        frames,
        names=(*frames.names, "anna/fore", "anna/hand"),
        xyz=(*frames.xyz, (0.05, 0.5, 0.3), (0.05, 0.28, 0.3)),
        xyzw=(*frames.xyzw, lying, lying),
    )


def planning_scene(*, post_at: Vector3 = (0.0, -0.05, 0.15)) -> PlanningSceneState:
    """One obstacle of each shape, the table that is drawn anyway, and a part that the right arm holds."""
    shapes: dict[str, tuple[Shape, Vector3]] = {
        "post": (Cylinder(radius_m=0.04, length_m=0.3), post_at),
        "crate": (Box(size_m=(0.2, 0.15, 0.12)), (-0.2, -0.3, 0.08)),
        "ball": (Sphere(radius_m=0.07), (0.25, -0.32, 0.09)),
        "rail": (Capsule(radius_m=0.025, length_m=0.25), (0.3, 0.3, 0.17)),
        "wedge": (
            Hull(points_m=((0.0, 0.0, 0.0), (0.2, 0.0, 0.0), (0.0, 0.2, 0.0), (0.0, 0.0, 0.15))),
            (-0.4, 0.25, 0.02),
        ),
        "table": (Box(size_m=(1.6, 1.2, 0.04)), (0.0, 0.0, -0.02)),
    }
    held = HeldPart(
        name="cup",
        robot="right",
        link="fore",
        solids=(Solid(shape=Cylinder(radius_m=0.03, length_m=0.1)),),
        pose=Pose(xyz=(0.0, 0.0, 0.44)),
    )
    return PlanningSceneState(
        revision=1,
        obstacles=tuple(Obstacle.of(name, shape, Pose(xyz=xyz)) for name, (shape, xyz) in shapes.items()),
        held=(held,),
        allowed=(),
    )


def occupancy(*, revision: int = 1, reach: float = 0.0) -> OccupancyGrid:
    """An arm that reaches over the table from behind, by `reach` metres, and a heap beside it."""
    shape, voxel_m = (50, 60, 30), 0.02
    x, y, z = ((np.indices(shape) + 0.5) * voxel_m + np.array([-0.5, -0.6, 0.0]).reshape(3, 1, 1, 1)).astype(float)
    arm = (np.hypot(x - 0.05, z - 0.3) < 0.07) & (y > 0.3 - reach)
    heap = z < 0.16 * np.exp(-((x + 0.25) ** 2 + (y - 0.1) ** 2) / 0.01)
    return OccupancyGrid(
        time_s=float(revision),
        revision=revision,
        corner_m=(-0.5, -0.6, 0.0),
        voxel_m=voxel_m,
        shape=shape,
        occupied=np.packbits(arm | heap).tobytes(),
    )


def occupancy_state(*, stale_reason: str = "") -> OccupancyState:
    """Whether the map can be relied on."""
    return OccupancyState(
        stale_reason=stale_reason, made="here", revision=1, looks=1, dropped=0, image_s=0.0, mapping_s=0.0
    )


def camera(name: str = "above") -> CameraInfo:
    """A camera over the table."""
    return CameraInfo(camera=name, intrinsics=LENS, pose=CAMERA_POSE, rate_hz=10.0, range_m=(0.2, 3.0))


def depth(name: str = "above", *, time_s: float = 0.0) -> DepthImage:
    """A slope with a ball before it, and a corner where nothing was measured."""
    v, u = np.indices((LENS.height_px, LENS.width_px))
    depth_m = np.where(np.hypot(u - 160, v - 120) < 60, 0.7, 1.8 - 0.004 * v)
    depth_m[:40, :60] = 0.0
    return DepthImage(
        time_s=time_s, camera=name, intrinsics=LENS, pose=CAMERA_POSE, depth_m=depth_m.astype(np.float32).tobytes()
    )


def detections(
    name: str = "above",
    *,
    time_s: float = 0.0,
    at: Vector3 = (0.15, -0.1, 0.05),
    score: float = 0.92,
    only: Literal["cup", "plate", ""] = "",
) -> Detections:
    """A cup, turned a little and seen at 100, 80 to 180, 160 px, and a plate of which half is hidden."""
    turn = (0.0, 0.0, math.sin(0.3), math.cos(0.3))
    both = (
        Detection(
            label="cup",
            score=score,
            pose=Pose(xyz=at, xyzw=turn),
            size_m=(0.08, 0.06, 0.1),
            rectangle_px=(100.0, 80.0, 180.0, 160.0),
        ),
        Detection(
            label="plate",
            score=0.47,
            pose=Pose(xyz=(-0.1, 0.0, 0.01)),
            size_m=(0.2, 0.2, 0.02),
            rectangle_px=(200.0, 100.0, 260.0, 190.0),
        ),
    )
    return Detections(
        camera=name,
        frame="world",
        time_s=time_s,
        detections=tuple(each for each in both if only in ("", each.label)),
        image_px=(LENS.width_px, LENS.height_px),
        fresh_s=1.0,
    )
