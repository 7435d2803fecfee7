"""The fixtures of modules in a compiled world: they stand at their module, or far away while it is not plugged."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np

from robots.model.transform import RigidTransform
from robots.port import Array
from robots.scene.sim_scene import ModuleBodies
from robots.sim.physics.cell_model import CellModel

POSE_FIELDS = 8
"""Numbers of a module in an image: 1 if it is plugged, then the pose of its frame, x y z and quaternion x y z w."""

_AWAY_M, _APART_M = 1000.0, 20.0

PlaceBody = Callable[[int, Array, Array], None]
"""Places a body, by its number, at a position (3,) with a quaternion x y z w (4,)."""


def away(body: int) -> RigidTransform:
    """Return where a body is that is not in the cell: far from all cameras, and touching nothing."""
    return RigidTransform(xyz=np.array([_AWAY_M + _APART_M * body, 0.0, -_AWAY_M]), xyzw=np.array([0.0, 0.0, 0.0, 1.0]))


@dataclass(frozen=True, kw_only=True)
class ModuleFixtures:
    """The fixtures of one module: the numbers of their bodies, with their poses in the frame of the module.

    What is `carried` is on a platform, and moves with it. `bases` are the bodies to which legs keep a platform: they
    stay at their place beside each other while the module is away.
    """

    name: str
    bodies: dict[int, RigidTransform]
    carried: frozenset[int] = frozenset()
    bases: dict[int, int] = field(default_factory=dict[int, int])

    @classmethod
    def of(cls, cell: CellModel, module: ModuleBodies) -> ModuleFixtures:
        """Return those of a module of a compiled world."""
        inverse, shapes = (
            RigidTransform.from_pose(module.at).inverse(),
            {each.name: each for each in cell.scene.fixtures},
        )
        numbers = {name: cell.body_names.index(name) for name in module.fixtures}
        legs = {name: body for name in module.fixtures if (body := shapes[name].hexapod) is not None}
        return cls(
            name=module.name,
            bodies={
                number: inverse.then(RigidTransform.from_pose(shapes[name].pose))
                for name, number in numbers.items()
                if not shapes[name].on
            },
            carried=frozenset(number for name, number in numbers.items() if shapes[name].on),
            bases={numbers[name]: numbers[body.base] for name, body in legs.items()},
        )

    @property
    def touchable(self) -> set[int]:
        """The numbers of all bodies, also of those that are carried."""
        return {*self.bodies, *self.carried}

    def put(self, pose: RigidTransform | None, *, place: PlaceBody) -> None:
        """Place them with their module, or far away, None."""
        for body, inner in self.bodies.items():
            at = pose.then(inner) if pose is not None else self._away(body, inner)
            place(body, at.xyz, at.xyzw)

    def _away(self, body: int, inner: RigidTransform) -> RigidTransform:
        if body not in self.bases:
            return away(body)
        base = self.bases[body]
        return away(base).then(self.bodies[base].inverse()).then(inner)


def read_pose(numbers: Array) -> RigidTransform | None:
    """Return the pose of a module from its numbers in an image, (`POSE_FIELDS`,); None while it is not plugged."""
    if not numbers[0]:
        return None
    return RigidTransform(xyz=numbers[1:4].copy(), xyzw=numbers[4:8].copy())


def write_pose(pose: RigidTransform | None, numbers: Array) -> None:
    """Write the pose of a module as `read_pose` reads it."""
    numbers[:] = 0.0
    if pose is not None:
        numbers[0], numbers[1:4], numbers[4:8] = 1.0, pose.xyz, pose.xyzw
