"""Parts that something outside holds: in tools with drivers, or in another world.

They follow the tool as long as the real one reports that it holds something. The world does not know what is in a real
tool: it takes the part at the tool centre point. A part of another world is where that has it. A part that is let go
is free again where it is.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from engine.messages import Pose
from robots.model.transform import RigidTransform
from robots.port import Array
from robots.scene.sim_scene import PartBody
from robots.sim.physics.cell_model import CellModel
from robots.sim.physics.physics import Physics

# The real part may be that far from where the world has it, besides the width of the fingers.
_NEAR_M = 0.03


@dataclass(frozen=True)
class _HeldPart:
    number: int
    pose: RigidTransform
    """In the frame of the tool link."""


class HeldParts:
    """Owned by the simulation; call `place` before the physics of a step."""

    def __init__(self, cell: CellModel, physics: Physics) -> None:
        self._physics = physics
        self._shapes = {part.name: part for part in cell.scene.parts}
        self._parts = cell.parts
        self._qpos = cell.free_qpos.reshape(-1, 7)
        self._dof = cell.free_dof.reshape(-1, 6)
        self._links = {arm.name: physics.body_number(f"{arm.name}/{arm.model.tool_link}") for arm in cell.arms}
        self._reported: set[str] = set()
        self._held: dict[str, _HeldPart] = {}
        self._mirrored: dict[int, RigidTransform] = {}

    def report(self, arm: str, *, held: bool) -> None:
        """Take what the tool of an arm reports, each time it does."""
        if held and arm not in self._reported:
            self._reported.add(arm)
            self._take(arm)
        elif not held:
            self._reported.discard(arm)
            self._held.pop(arm, None)

    def mirror(self, part: str, pose: Pose | None) -> None:
        """Take where another world has a part, None where that lets it go."""
        number = self._parts.index(part)
        if pose is None:
            self._mirrored.pop(number, None)
        else:
            self._mirrored[number] = RigidTransform.from_pose(pose)

    def place(self) -> None:
        """Place the held parts at their tools, and the mirrored ones where they are, at rest."""
        for arm, part in self._held.items():
            self._place(part.number, self._link(arm).then(part.pose))
        for number, pose in self._mirrored.items():
            self._place(number, pose)

    def _place(self, number: int, pose: RigidTransform) -> None:
        x, y, z, w = pose.xyzw
        self._physics.positions[self._qpos[number]] = (*pose.xyz, w, x, y, z)
        self._physics.velocities[self._dof[number]] = 0.0

    def number(self, arm: str) -> int:
        """Return the number of the part that follows the tool of an arm, -1 for none."""
        return self._held[arm].number if arm in self._held else -1

    def restart(self) -> None:
        """Take anew what the tools hold, after the world was restored; a part would fall until the next report."""
        self._held.clear()
        for arm in self._reported:
            self._take(arm)

    def _take(self, arm: str) -> None:
        link = self._link(arm)
        poses = [self._pose(number) for number in range(len(self._parts))]
        gaps = [gap_m(self._shapes[name], pose, link.xyz) for name, pose in zip(self._parts, poses, strict=True)]
        nearest = int(np.argmin(gaps)) if gaps else -1
        if nearest >= 0 and gaps[nearest] <= _NEAR_M:
            self._held[arm] = _HeldPart(nearest, link.inverse().then(poses[nearest]))

    def _link(self, arm: str) -> RigidTransform:
        xyz, wxyz = self._physics.body_poses(np.array([self._links[arm]]))
        return RigidTransform(xyz=xyz[0].copy(), xyzw=np.roll(wxyz[0], -1))

    def _pose(self, number: int) -> RigidTransform:
        place = self._physics.positions[self._qpos[number]]
        return RigidTransform(xyz=place[:3].copy(), xyzw=np.roll(place[3:], -1))


def gap_m(part: PartBody, pose: RigidTransform, point: Array) -> float:
    """Return the distance of a point in the world from the surface of a part, 0 inside."""
    inside = pose.inverse().then(RigidTransform(xyz=point, xyzw=np.array([0.0, 0.0, 0.0, 1.0]))).xyz
    match part.shape:
        case "sphere":
            beyond = np.array([np.linalg.norm(inside) - part.size_m[0] / 2])
        case "cylinder":
            beyond = np.array([np.hypot(*inside[:2]) - part.size_m[0] / 2, abs(inside[2]) - part.size_m[1] / 2])
        case _:
            beyond = np.abs(inside) - np.array(part.size_m) / 2
    return float(np.linalg.norm(np.maximum(beyond, 0.0)))
