"""The IRB 4600 with a person's arm in view of 640 x 480 cameras and voxels of 2 cm: what `perception.py` looks at."""

from __future__ import annotations

from pathlib import Path

import msgspec
import numpy as np

from engine.document.cell import CellDocument, load_cell
from engine.document.cell_perception import OccupancyMap
from engine.messages import Vector3
from engine.messages.shapes import Capsule, Shape, Sphere
from robots.model.transform import RigidTransform
from robots.planning.scene.convex_shapes import convex_solid, to_frame
from robots.port import Array
from robots.scene.scene_builder import build_scene
from robots.scene.sim_scene import SimScene
from robots.sim.loop.simulation import Simulation
from robots.sim.physics.cell_model import build_cell
from robots.sim.physics.limb import Limb
from robots.sim.physics.person_spec import FOREARM_SHARE
from robots.vision.cameras.camera import camera_of
from robots.vision.perception_messages import PerceptionRequest, PerceptionSetup
from robots.vision.voxel_box import VoxelBox, voxel_box

CELL = Path(__file__).parent / "cells" / "irb4600_near.yaml"
_SIZE_PX = (640, 480)
_HANDS: tuple[Vector3, ...] = ((1.1, 0.2, 1.1), (1.2, 0.0, 1.0), (1.3, 0.5, 1.0), (1.25, 0.1, 1.35), (1.15, 0.35, 0.95))


def document(*, cameras: int) -> CellDocument:
    """Return the cell with this many of its cameras, at full size, and voxels of 2 cm."""
    made = load_cell(CELL).document
    seen_by = {
        name: msgspec.structs.replace(camera, size_px=_SIZE_PX, rate_hz=10.0)
        for name, camera in list(made.cameras.items())[:cameras]
    }
    box = OccupancyMap(center_m=(1.0, 0.0, 1.15), size_m=(1.28, 1.92, 1.2), voxel_m=0.02)
    return msgspec.structs.replace(made, cameras=seen_by, occupancy=box)


def perception_setup(cell: CellDocument, scene: SimScene) -> PerceptionSetup:
    """Return what is looked at."""
    assert cell.occupancy is not None
    named = tuple(camera_of(name, camera) for name, camera in cell.cameras.items())
    return PerceptionSetup(scene=scene, cameras=named, box=voxel_box(cell.occupancy))


def scene_with(cell: CellDocument, *, person: bool) -> SimScene:
    """Return the scene of a cell, with its person or without."""
    scene = build_scene(cell, resolve=lambda path: (CELL.parent / path).resolve())
    return scene if person else msgspec.structs.replace(scene, people=())


class Stage:
    """A simulated cell that is put where the benchmark wants it, without stepping it."""

    def __init__(self, scene: SimScene, cameras: tuple[str, ...]) -> None:
        self.scene = scene
        self._cameras = cameras
        self._cell = build_cell(scene)
        self._simulation = Simulation(self._cell)
        self._image = np.zeros(self._simulation.image_layout.size)
        self._simulation.write_image(self._image)
        # In MuJoCo's integration state the time comes first, then the positions.
        self._q = self._image[self._simulation.image_layout.physics][1:]
        limits = self._cell.arms[0].model.limits
        self.lower, self.upper = (np.clip(side, -np.pi, np.pi) for side in (limits.lower_rad, limits.upper_rad))

    def put_arm(self, joints: Array) -> None:
        """Put the arm's joints here."""
        self._q[self._cell.arms[0].qpos] = joints

    def put_hand(self, number: int) -> Array:
        """Let the person's hand be at one of some places; return points all over its arm, (k, 3), world."""
        person = self.scene.people[0]
        hand = np.array(_HANDS[number % len(_HANDS)])
        limb = Limb(person)
        pose = limb.pose(hand, limb.hanging(hand))
        self._q[self._cell.people[0].qpos] = np.hstack((pose.xyz, pose.wxyz)).ravel()
        shapes: tuple[Shape, ...] = (
            Capsule(radius_m=person.radius_m, length_m=person.upper_arm_m),
            Capsule(radius_m=FOREARM_SHARE * person.radius_m, length_m=person.forearm_m),
            Sphere(radius_m=person.radius_m),
        )
        return np.vstack(
            [
                to_frame(RigidTransform.of(xyz, np.roll(wxyz, -1)), convex_solid(shape).surface(0.01))
                for shape, xyz, wxyz in zip(shapes, pose.xyz, pose.wxyz, strict=True)
            ]
        )

    def look(self, *, forget: bool = False) -> PerceptionRequest:
        """Return the order to look at it as it is."""
        return PerceptionRequest(time_s=0.0, state=self._image, cameras=self._cameras, forget=forget)


def inside(box: VoxelBox, points: Array) -> Array:
    """Return those of the points (k, 3) that lie in the box."""
    cells = (points - np.array(box.corner_m)) / box.voxel_m
    return points[((cells >= 0.0) & (cells < np.array(box.shape))).all(axis=1)]
