"""The latest message of each kind: written by the event loop's thread, read by the drawing thread."""

from __future__ import annotations

import threading

from engine.messages import FramePoses, JointSetPoint, RobotDescription, SceneDescription
from engine.messages.sensing import CameraInfo, DepthImage, ObservedSpace, OccupancyGrid, OccupancyState
from engine.skills.jogging import JogBlock
from engine.skills.planning import PathPreview
from engine.skills.planning_scene import PlanningSceneState
from engine.skills.vision import Detections


class LatestMessages:
    """One reference per kind, the latest message wins; `arrived` is set with every message.

    `descriptions`, `set_points`, `paths`, `blocks`, `cameras`, `depths` and `detections` are by the name of the arm or
    camera.
    Messages are frozen, so that a reader always sees a complete one.
    """

    def __init__(self) -> None:
        self.arrived = threading.Event()
        self.scene: SceneDescription | None = None
        self.frames: FramePoses | None = None
        self.planning_scene: PlanningSceneState | None = None
        self.occupancy: OccupancyGrid | None = None
        self.observed_space: ObservedSpace | None = None
        self.descriptions: dict[str, RobotDescription] = {}
        self.set_points: dict[str, JointSetPoint] = {}
        self.paths: dict[str, PathPreview] = {}
        self.blocks: dict[str, JogBlock] = {}
        self.occupancy_state: OccupancyState | None = None
        self.cameras: dict[str, CameraInfo] = {}
        self.depths: dict[str, DepthImage] = {}
        self.detections: dict[str, Detections] = {}

    def put(self, name: str, message: object) -> None:
        """Store a message; `name` is that of its arm or camera, if it has one."""
        match message:
            case SceneDescription():
                self.scene = message
            case FramePoses():
                self.frames = message
            case PlanningSceneState():
                self.planning_scene = message
            case OccupancyGrid():
                self.occupancy = message
            case ObservedSpace():
                self.observed_space = message
            case OccupancyState():
                self.occupancy_state = message
            case CameraInfo():
                self.cameras = {**self.cameras, name: message}
            case RobotDescription():
                self.descriptions = {**self.descriptions, name: message}
            case JointSetPoint():
                self.set_points = {**self.set_points, name: message}
            case PathPreview():
                self.paths = {**self.paths, name: message}
            case JogBlock():
                self.blocks = {**self.blocks, name: message}
            case DepthImage():
                self.depths = {**self.depths, name: message}
            case Detections():
                self.detections = {**self.detections, name: message}
            case _:
                return
        self.arrived.set()
