"""The modules of a simulation: they come and go between two steps, and nothing else of the state changes.

The model of a world has the bodies of all its modules. Those of a module that is not plugged are far away and at
rest there. So no index changes, nothing is compiled while arms move, and a module is there with the next step.
"""

from __future__ import annotations

from collections.abc import Callable, Collection
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from robots.model.transform import RigidTransform
from robots.port import Array
from robots.sim.commands.world_commands import ModulePlaced, PlaceModule
from robots.sim.physics.cell_model import CellModel
from robots.sim.physics.module_fixtures import POSE_FIELDS, ModuleFixtures, away, read_pose, write_pose
from robots.sim.physics.physics import Physics

# What is so near touches: bodies at rest keep a small distance, or are a little in one another.
_TOUCHING_M = 0.002
_OVERLAP_M = -0.001


@dataclass(kw_only=True)
class _ModulePart:
    """A part of a module; its pose in the frame of the module counts while it is away with it."""

    name: str
    body: int
    qpos: NDArray[np.intp]
    dof: NDArray[np.intp]
    home: RigidTransform
    inner: RigidTransform
    is_away: bool = False


@dataclass(kw_only=True)
class _DockedModule:
    """One module; `pose` is None while it is not plugged."""

    fixtures: ModuleFixtures
    parts: tuple[_ModulePart, ...]
    pose: RigidTransform | None


class DockedModules:
    """Owned by the simulation; call `pin` before the physics of a step.

    In an image, each module has its pose as in `module_fixtures`, and after all modules each of their parts: 1 if it
    is away, and its pose on the module.
    """

    def __init__(self, cell: CellModel, physics: Physics, *, joined_to: Callable[[Collection[int]], set[int]]) -> None:
        self._physics = physics
        self._joined_to = joined_to
        self._names = cell.body_names
        self._fixed = {cell.body_names.index(one.name) for one in (*cell.scene.fixtures, *cell.scene.unknown_fixtures)}
        self._modules = {module.name: _module(cell, module.name) for module in cell.scene.modules}
        self._parts = [part for module in self._modules.values() for part in module.parts]
        self.image_size = POSE_FIELDS * (len(self._modules) + len(self._parts))
        self._away_qpos = self._away_dof = np.zeros(0, dtype=np.intp)
        self._away_poses = np.zeros(0)
        if self._modules:
            physics.prepare_probe()
        for module in self._modules.values():
            if module.pose is None:
                self._send_away(module, module.parts)
        if self._away_qpos.size:
            physics.refresh()

    @property
    def away(self) -> tuple[str, ...]:
        """The parts that are away with their modules."""
        return tuple(part.name for part in self._parts if part.is_away)

    def pin(self) -> None:
        """Keep the parts that are away where they are."""
        if self._away_qpos.size:
            self._physics.positions[self._away_qpos] = self._away_poses
            self._physics.velocities[self._away_dof] = 0.0

    def place(self, command: PlaceModule, *, held: frozenset[str]) -> ModulePlaced:
        """Plug or unplug a module, or change nothing and say why; `held` are the parts that follow driven tools."""
        module = self._modules[command.module]
        if command.pose is None:
            refused = self._unplug(module, held)
        else:
            refused = self._plug(module, RigidTransform.from_pose(command.pose))
        return ModulePlaced(refused=refused, away=self.away)

    def reset(self) -> None:
        """Return the parts of modules to where they are at the start: on their modules, wherever these are now."""
        for module in self._modules.values():
            for part in module.parts:
                part.inner = part.home
                self._put(part, module.pose)
        self._look_who_is_away()

    def write_image(self, image: Array) -> None:
        """Write where modules and their parts are, (`image_size`,)."""
        rows = image.reshape(-1, POSE_FIELDS)
        for row, module in zip(rows, self._modules.values(), strict=False):
            write_pose(module.pose, row)
        for row, part in zip(rows[len(self._modules) :], self._parts, strict=True):
            write_pose(part.inner, row)
            row[0] = part.is_away

    def take_over(self, image: Array) -> None:
        """Continue from an image; the poses of parts in the world are those of the physics, which is restored next."""
        rows = image.reshape(-1, POSE_FIELDS)
        for row, module in zip(rows, self._modules.values(), strict=False):
            module.pose = read_pose(row)
            module.fixtures.put(module.pose, place=self._physics.place_fixed)
        for row, part in zip(rows[len(self._modules) :], self._parts, strict=True):
            part.is_away = bool(row[0])
            part.inner = RigidTransform(xyz=row[1:4].copy(), xyzw=row[4:8].copy())
        self._look_who_is_away()

    def _plug(self, module: _DockedModule, pose: RigidTransform) -> str:
        arriving = [part for part in module.parts if part.is_away]
        module.pose = pose
        module.fixtures.put(pose, place=self._physics.place_fixed)
        for part in arriving:
            self._put(part, pose)
        bodies = {*module.fixtures.touchable, *(part.body for part in arriving)}
        others = self._physics.near(bodies, within_m=_OVERLAP_M)
        if others:
            self._send_away(module, tuple(arriving))
            return f"{self._named(others)} is where it would stand"
        self._look_who_is_away()
        return ""

    def _unplug(self, module: _DockedModule, held: frozenset[str]) -> str:
        own = {part.body: part for part in module.parts if not part.is_away}
        bodies = module.fixtures.touchable
        others: dict[int, float] = {}
        while bodies:
            near = self._physics.near(bodies, within_m=_TOUCHING_M)
            joined = self._joined_to(bodies)
            going = own.keys() & (near.keys() | joined)
            others = {body: gap_m for body, gap_m in near.items() if body not in going and body not in self._fixed}
            others |= dict.fromkeys(joined - going, 0.0)
            if not going:
                break
            bodies |= going
        if others:
            return f"{self._named(others)} touches it"
        parts = tuple(part for body, part in own.items() if body in bodies)
        carried = next((part.name for part in parts if part.name in held), "")
        if carried:
            return f"a tool holds {carried}, which is on it"
        assert module.pose is not None
        inverse = module.pose.inverse()
        for part in parts:
            xyz, xyzw = self._physics.pose_now(part.qpos)
            part.inner = inverse.then(RigidTransform(xyz=xyz, xyzw=xyzw))
        self._send_away(module, parts)
        return ""

    def _send_away(self, module: _DockedModule, parts: tuple[_ModulePart, ...]) -> None:
        module.pose = None
        module.fixtures.put(None, place=self._physics.place_fixed)
        for part in parts:
            self._put(part, None)
        self._look_who_is_away()

    def _put(self, part: _ModulePart, pose: RigidTransform | None) -> None:
        at = pose.then(part.inner) if pose is not None else away(part.body)
        self._physics.place_free(part.qpos, part.dof, at.xyz, at.xyzw, body=part.body)
        part.is_away = pose is None

    def _look_who_is_away(self) -> None:
        gone = [part for part in self._parts if part.is_away]
        empty = np.zeros(0, dtype=np.intp)
        self._away_qpos = np.concatenate([empty, *(part.qpos for part in gone)])
        self._away_dof = np.concatenate([empty, *(part.dof for part in gone)])
        places = [away(part.body) for part in gone]
        self._away_poses = np.concatenate([np.zeros(0), *((*at.xyz, *np.roll(at.xyzw, 1)) for at in places)])

    def _named(self, others: dict[int, float]) -> str:
        """Return the name of what is nearest."""
        return self._names[min(others, key=lambda body: others[body])]


def _module(cell: CellModel, name: str) -> _DockedModule:
    bodies = next(module for module in cell.scene.modules if module.name == name)
    at = RigidTransform.from_pose(bodies.at)
    shapes = {part.name: part for part in cell.scene.parts}
    qpos, dof = cell.free_qpos.reshape(-1, 7), cell.free_dof.reshape(-1, 6)
    parts: list[_ModulePart] = []
    for part in bodies.parts:
        row = cell.parts.index(part)
        home = at.inverse().then(RigidTransform.from_pose(shapes[part].pose))
        body = cell.body_names.index(part)
        parts.append(_ModulePart(name=part, body=body, qpos=qpos[row], dof=dof[row], home=home, inner=home))
    pose = at if bodies.plugged else None
    return _DockedModule(fixtures=ModuleFixtures.of(cell, bodies), parts=tuple(parts), pose=pose)
