"""The occupancy map from depth images, minus the known geometry. Independent of cameras and simulator."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass

import msgspec
import numpy as np

from engine.errors import CellError
from engine.messages.sensing import DepthImage, ObservedSpace, OccupancyGrid
from engine.messages.shapes import Obstacle
from robots.model.transform import RigidTransform
from robots.port import Array
from robots.scene.sim_scene import ArmPlacement
from robots.vision.cameras.camera import Image, depths
from robots.vision.known_geometry import KnownGeometry, MeasuredState
from robots.vision.occupancy.arm_body import ArmBody
from robots.vision.occupancy.known_voxels import KnownVoxels
from robots.vision.occupancy.observation_kernels import NEVER, mark_seen, write_ages
from robots.vision.occupancy.occupancy_kernels import (
    Bytes,
    apply_evidence,
    count_hits,
    grade_hits,
    look_through,
    stamp_balls,
    unknown_voxels,
)
from robots.vision.voxel_box import VoxelBox

SHARE_OF_WHOLE = 0.2
"""A voxel counts as well hit with this share of the pixels that its face would fill at that distance."""
COMPANY = 2
"""Number of its 26 neighbours that must be hit too for a voxel to be filled at once."""
EDGE_IMAGES = 2
"""Consecutive images with hits that fill a voxel adjacent to a filled one."""
LONE_IMAGES = 3
"""Consecutive images with hits that fill an isolated voxel."""
MISSES_TO_CLEAR = 2
"""Images that look through a voxel, without a hit in between, that clear it."""
MISSES_BESIDE = 20
"""The same next to a well hit voxel: edges of objects are hit in some images only."""


@dataclass(frozen=True, kw_only=True)
class _View:
    depth: Image
    lens: Array
    turn: Array
    place: Array


class OccupancyMapper:
    """Fills and clears the voxels of a box from depth images.

    A voxel with measured points is filled at once if its neighbours have some too, as on a person's
    arm; an isolated one must be hit in three consecutive images, which noise does not do. It is cleared after two
    images that look through it, or more at the edges of objects. Voxels that no image shows keep their state. Nothing
    is filled near the arms, held parts and known obstacles; filled voxels near a known obstacle are excluded, and
    cleared inside it. Voxels filled before an arm came near stay filled, and those hidden by its covering balls
    reappear when it has moved on.

    Args:
        box: The voxels, and the margins around known geometry.
        arms: All arms in view of the cameras.
        far_m: How far each camera measures, by name; without a limit where it is missing.

    Raises:
        CellError: the model of an arm cannot be read.
    """

    def __init__(
        self, box: VoxelBox, arms: Iterable[ArmPlacement], *, far_m: Mapping[str, float] | None = None
    ) -> None:
        self.box = box
        self._corner = np.array(box.corner_m, dtype=np.float64)
        self._shape = np.array(box.shape, dtype=np.int32)
        self._arms = {arm.name: ArmBody(arm) for arm in arms}
        self._near_arm = max(box.robot_margin_m, box.reach_m)
        self._voxels = KnownVoxels(box)
        self._known = KnownGeometry()
        size = math.prod(box.shape)
        self._counts = np.zeros(size, dtype=np.int32)
        self._touched, self._hit, self._waiting = (np.empty(size, dtype=np.int32) for _ in range(3))
        self._waits = 0
        self._levels, self._full, self._misses, self._streak, self._out = (
            np.zeros(size, dtype=np.uint8) for _ in range(5)
        )
        self._far_m = dict(far_m or {})
        self._seen = np.full(size, NEVER, dtype=np.int32)
        self._taken_then: Bytes = np.zeros(size, dtype=np.uint8)
        self._revision = 0
        self._bits = np.packbits(self._out).tobytes()

    def know(self, known: KnownGeometry) -> None:
        """Exclude these obstacles and held parts from the next update on."""
        self._known = known

    def forget(self) -> None:
        """Restart with an empty map; the revision keeps increasing."""
        for array in (self._full, self._misses, self._streak):
            array[:] = 0
        self._seen[:] = NEVER
        self._waits = 0

    def update(self, images: Iterable[DepthImage], moment: MeasuredState) -> OccupancyGrid:
        """Return the map after one more image of each of some cameras, taken in the state `moment`.

        Raises:
            CellError: an image has invalid bytes, intrinsics or pose, a configuration is of another arm, or a known
                shape is invalid. The map is unchanged.
        """
        views = [_view(image) for image in images]
        taken = self._taken_then = self._taken(moment)
        hits = 0
        for view in views:
            hits = self._count(view, taken, hits)
        filled = np.flatnonzero(self._full)
        watched = np.concatenate((filled, self._waiting[: self._waits].astype(np.int64)))
        through = np.zeros(len(watched), dtype=np.uint8)
        for view in views:
            look_through(
                watched,
                view.depth,
                view.lens,
                view.turn,
                view.place,
                self._corner,
                self.box.voxel_m,
                self._shape,
                self.box.reach_m,
                through,
            )
        self._waits = apply_evidence(
            self._hit,
            hits,
            self._levels,
            filled,
            through,
            taken,
            self._shape,
            COMPANY,
            EDGE_IMAGES,
            LONE_IMAGES,
            MISSES_TO_CLEAR,
            MISSES_BESIDE,
            self._full,
            self._misses,
            self._streak,
            self._waiting,
            self._waits,
        )
        unknown_voxels(self._full, taken, self._out)
        return self._grid(moment.time_s)

    def observe(self, images: Iterable[DepthImage], *, time_s: float) -> ObservedSpace:
        """Return when each voxel was last seen before `time_s`, also in these images; call it after `update`.

        Raises:
            CellError: as `update`.
        """
        box = self.box
        for image in images:
            view = _view(image)
            mark_seen(
                view.depth,
                view.lens,
                view.turn,
                view.place,
                self._corner,
                box.voxel_m,
                self._shape,
                box.reach_m,
                self._far_m.get(image.camera, math.inf),
                _hundredths(image.time_s),
                self._seen,
            )
        ages = np.empty(len(self._seen), dtype=np.uint8)
        write_ages(self._seen, self._taken_then, _hundredths(time_s), ages)
        return ObservedSpace(
            time_s=time_s,
            corner_m=box.corner_m,
            voxel_m=box.voxel_m,
            shape=box.shape,
            limit_s=box.seen_within_s,
            ages=ages.tobytes(),
        )

    def _count(self, view: _View, taken: Bytes, hits: int) -> int:
        box = self.box
        found = count_hits(
            view.depth,
            view.lens,
            view.turn,
            view.place,
            self._corner,
            box.voxel_m,
            self._shape,
            taken,
            self._counts,
            self._touched,
        )
        return grade_hits(
            self._touched,
            found,
            self._counts,
            view.lens,
            view.turn,
            view.place,
            self._corner,
            box.voxel_m,
            self._shape,
            SHARE_OF_WHOLE,
            self._levels,
            self._hit,
            hits,
        )

    def _taken(self, moment: MeasuredState) -> Bytes:
        """Return the known occupancy of each voxel at that instant."""
        still: list[Obstacle] = []
        moving: list[Obstacle] = []
        for thing in self._known.obstacles:
            if thing.name in moment.parts:
                moving.append(msgspec.structs.replace(thing, pose=moment.parts[thing.name]))
            else:
                still.append(thing)
        self._voxels.set_still(still)
        taken = self._voxels.taken(moving, self._held(moment))
        for name, posture in moment.arms.items():
            balls = self._body(name).balls(posture)
            stamp_balls(balls, self._near_arm, self._corner, self.box.voxel_m, self._shape, taken)
        return taken

    def _held(self, moment: MeasuredState) -> Iterable[Obstacle]:
        for part in self._known.held:
            pose = moment.parts.get(part.name)
            if pose is None and part.arm in moment.arms:
                body = self._body(part.arm)
                link = body.link_pose(moment.arms[part.arm], part.link or body.tool_link)
                pose = link.then(RigidTransform.from_pose(part.pose)).to_pose("world")
            if pose is not None:
                yield Obstacle(name=part.name, solids=part.solids, pose=pose)

    def _body(self, name: str) -> ArmBody:
        if name not in self._arms:
            raise CellError(f"the map has no arm {name}", where="occupancy", hint=f"its arms are {list(self._arms)}")
        return self._arms[name]

    def _grid(self, time_s: float) -> OccupancyGrid:
        bits = np.packbits(self._out).tobytes()
        if bits != self._bits or self._revision == 0:
            self._bits = bits
            self._revision += 1
        box = self.box
        return OccupancyGrid(
            time_s=time_s,
            revision=self._revision,
            corner_m=box.corner_m,
            voxel_m=box.voxel_m,
            shape=box.shape,
            occupied=bits,
        )


def _hundredths(time_s: float) -> int:
    return round(100.0 * time_s)


def _view(image: DepthImage) -> _View:
    lens = image.intrinsics
    numbers = np.array([lens.fx_px, lens.fy_px, lens.cx_px, lens.cy_px], dtype=np.float64)
    where = f"camera {image.camera}"
    if not np.isfinite(numbers).all() or min(lens.fx_px, lens.fy_px) <= 0.0:
        raise CellError(
            f"{numbers.tolist()} are not intrinsics", where=where, hint="give focal lengths above 0 and a centre"
        )
    try:
        pose = RigidTransform.from_pose(image.pose)
    except ValueError as error:
        raise CellError(str(error), where=where, hint="give the pose of the camera") from error
    return _View(depth=depths(image), lens=numbers, turn=pose.rotation, place=pose.xyz)
