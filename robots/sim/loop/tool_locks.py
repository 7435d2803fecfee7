"""The locks of tool changers in a simulation: a piston catches what is there when it arrives, with limited force."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial

import numpy as np

from engine.document import ToolChangerSpec, seconds
from robots.model.folder.master_plate import MASTER_FACE
from robots.model.transform import RigidTransform
from robots.port import Array
from robots.scene.sim_scene import PartBody
from robots.sim.commands.world_commands import SwitchToolLock
from robots.sim.physics.cell_model import CellModel
from robots.sim.physics.physics import Physics
from robots.sim.physics.tool_coupling import coupling_name

# The switch in the face is on a little farther than the lock can reach.
_PRESENT = 2.0


@dataclass(kw_only=True)
class _Lock:
    spec: ToolChangerSpec
    face: int
    travel: int
    couplings: tuple[int, ...]
    on: bool = False
    left: int = 0


@dataclass(frozen=True, kw_only=True)
class _Tool:
    body: int
    number: int
    """Its number among the parts."""
    face_m: float


class ToolLocks:
    """Owned by the simulation; call `step` after the physics of a step."""

    def __init__(self, cell: CellModel, physics: Physics) -> None:
        self._physics = physics
        tools = [part for part in cell.scene.parts if part.tool is not None]
        self._tools = [_tool(cell, part) for part in tools]
        self._locks = {
            arm.name: _Lock(
                spec=arm.tool_changer,
                face=physics.body_number(f"{arm.name}/{MASTER_FACE}"),
                travel=max(1, round(seconds(arm.tool_changer.time) / physics.step_s)),
                couplings=tuple(physics.coupling_number(coupling_name(arm.name, tool.name)) for tool in tools),
            )
            for arm in cell.scene.arms
            if arm.tool_changer is not None
        }

    @property
    def moving(self) -> dict[str, Callable[[], bool]]:
        """What tells whether the piston of a lock travels, by arm."""
        return {arm: partial(_travels, lock) for arm, lock in self._locks.items()}

    def switch(self, command: SwitchToolLock) -> None:
        """Turn the output of a lock on or off from the next step on; the piston travels then."""
        lock = self._locks[command.arm]
        if lock.on != command.on:
            lock.on, lock.left = command.on, lock.travel

    def step(self) -> None:
        """Let pistons arrive, and let go what is pulled with more force than a lock holds."""
        for lock in self._locks.values():
            if lock.left:
                lock.left -= 1
                if lock.left == 0:
                    self._arrive(lock)
            held = self._held(lock)
            if held >= 0 and self._is_overloaded(lock, held):
                self._physics.couple(lock.couplings[held], on=False)

    def number(self, arm: str) -> int:
        """Return the number, among the parts, of the tool that an arm has; -1 for none."""
        lock = self._locks.get(arm)
        held = self._held(lock) if lock is not None else -1
        return self._tools[held].number if held >= 0 else -1

    def read(self, arm: str) -> tuple[bool, bool, bool]:
        """Return output and sensors of the lock of an arm, as in a snapshot."""
        lock = self._locks[arm]
        present = any(self._meets(lock, tool, factor=_PRESENT) for tool in self._tools)
        return lock.on, self._held(lock) >= 0, present

    def reset(self) -> None:
        """Open all locks: the parts go back to where they are at the start."""
        for lock in self._locks.values():
            lock.on, lock.left = False, 0
            self._arrive(lock)

    def write_image(self, arm: str, image: Array) -> None:
        """Write the memory of a lock, as in `ImageLayout.locks`."""
        lock = self._locks[arm]
        image[:] = lock.on, lock.left

    def take_over(self, arm: str, image: Array) -> None:
        """Continue from an image."""
        lock = self._locks[arm]
        lock.on, lock.left = bool(image[0]), int(image[1])

    def _arrive(self, lock: _Lock) -> None:
        caught = next((i for i, tool in enumerate(self._tools) if self._meets(lock, tool, factor=1.0)), -1)
        for index, coupling in enumerate(lock.couplings):
            self._physics.couple(coupling, on=lock.on and index == caught)

    def _held(self, lock: _Lock) -> int:
        return next((i for i, coupling in enumerate(lock.couplings) if self._physics.is_coupled(coupling)), -1)

    def _is_overloaded(self, lock: _Lock, held: int) -> bool:
        ((force_n, torque_nm),) = self._physics.coupling_loads((lock.couplings[held],))
        return force_n > lock.spec.force_n or torque_nm > lock.spec.torque_nm

    def _meets(self, lock: _Lock, tool: _Tool, *, factor: float) -> bool:
        """Return whether the plate of a tool is at the face, within so many tolerances."""
        reach_m = factor * lock.spec.tolerance_m
        if abs(self._physics.apart_m(lock.face, tool.body) - tool.face_m) > reach_m:
            return False
        xyz, wxyz = self._physics.body_poses(np.array([lock.face, tool.body]))
        face, plate = (RigidTransform(xyz=xyz[i], xyzw=np.roll(wxyz[i], -1)) for i in (0, 1))
        due = face.then(RigidTransform(xyz=np.array([0.0, 0.0, tool.face_m]), xyzw=np.array([0.0, 0.0, 0.0, 1.0])))
        return due.distance_m(plate) <= reach_m and due.angle_rad(plate) <= factor * lock.spec.tolerance_rad


def _travels(lock: _Lock) -> bool:
    return lock.left > 0


def _tool(cell: CellModel, part: PartBody) -> _Tool:
    return _Tool(body=cell.body_names.index(part.name), number=cell.parts.index(part.name), face_m=part.face_m)
