"""An arm with its tool as balls in the world, at any joint configuration."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from engine.errors import CellError
from robots.model.mechanics.pinocchio_model import pin, rest_configuration, whole_model
from robots.model.transform import RigidTransform
from robots.planning.search.arm_spheres import arm_spheres
from robots.port import Array
from robots.scene.sim_scene import ArmPlacement
from robots.vision.known_geometry import ArmConfiguration


@dataclass(frozen=True, kw_only=True)
class _Link:
    frame: int
    centres: Array
    """Of its balls, (k, 3), in the frame of the link."""
    rows: slice
    """Its balls among those of all links."""


class ArmBody:
    """The balls that cover all links of one arm; raises CellError if its model cannot be read."""

    def __init__(self, placement: ArmPlacement) -> None:
        model = placement.robot()
        self._base = RigidTransform.from_pose(placement.base)
        self._base_rotation = self._base.rotation
        self._name = placement.name
        self._joints = model.arm_joints
        self._solver: Any = whole_model(model)
        self._data: Any = self._solver.createData()
        self._rest: Array = np.array(rest_configuration(self._solver, model))
        self._places = {
            str(name): int(self._solver.joints[number].idx_q)
            for number, name in enumerate(self._solver.names)
            if number > 0
        }
        fitted = arm_spheres(model, ())
        self._links: dict[str, _Link] = {}
        radii: list[Array] = []
        first = 0
        for link, spheres in zip(fitted.links, fitted.spheres, strict=True):
            self._links[link] = _Link(
                frame=int(self._solver.getFrameId(link, pin.FrameType.BODY)),
                centres=_moved(fitted.frames[link][1].inverse(), spheres[:, :3]),
                rows=slice(first, first + len(spheres)),
            )
            radii.append(spheres[:, 3])
            first += len(spheres)
        self._radii = np.concatenate(radii)
        self.tool_link = model.tool_link

    def balls(self, posture: ArmConfiguration) -> Array:
        """Return the balls in the world, (k, 4); raises CellError for a posture of another arm."""
        self._move_to(posture)
        balls = np.empty((len(self._radii), 4))
        balls[:, 3] = self._radii
        turn, base_xyz = self._base_rotation, self._base.xyz
        for link in self._links.values():
            found = self._data.oMf[link.frame]
            rotation = turn @ found.rotation
            balls[link.rows, :3] = link.centres @ rotation.T + (turn @ found.translation + base_xyz)
        return balls

    @property
    def links(self) -> tuple[str, ...]:
        """The links with balls."""
        return tuple(self._links)

    def link_balls(self, posture: ArmConfiguration) -> dict[str, Array]:
        """Return the balls of each link in the world, (k, 4); raises CellError for a posture of another arm."""
        balls = self.balls(posture)
        return {name: balls[link.rows] for name, link in self._links.items()}

    def link_pose(self, posture: ArmConfiguration, link: str) -> RigidTransform:
        """Return the pose of a link in the world; raises CellError for an unknown link."""
        if not self._solver.existFrame(link, pin.FrameType.BODY):
            raise CellError(f"the arm has no link {link}", where=self._name, hint="name a link of the URDF")
        self._move_to(posture)
        return self._at(int(self._solver.getFrameId(link, pin.FrameType.BODY)))

    def _move_to(self, posture: ArmConfiguration) -> None:
        if len(posture.joints) != len(self._joints) or not np.isfinite(posture.joints).all():
            raise CellError(
                f"{list(posture.joints)} are not a joint configuration of this arm",
                where=self._name,
                hint=f"give {len(self._joints)} numbers",
            )
        q = self._rest.copy()
        for name, value in (*zip(self._joints, posture.joints, strict=True), *posture.tool_joints.items()):
            if name not in self._places:
                raise CellError(f"the arm has no joint {name}", where=self._name, hint="name a joint of the URDF")
            q[self._places[name]] = value
        pin.framesForwardKinematics(self._solver, self._data, q)

    def _at(self, frame: int) -> RigidTransform:
        found = self._data.oMf[frame]
        xyzw = np.array(pin.Quaternion(found.rotation).coeffs())
        return self._base.then(RigidTransform(xyz=np.array(found.translation), xyzw=xyzw))


def _moved(pose: RigidTransform, points: Array) -> Array:
    return points @ pose.rotation.T + pose.xyz
