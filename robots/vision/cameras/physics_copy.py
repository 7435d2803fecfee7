"""A copy of a simulated cell, set to the state of the world at an instant, for rendering."""

from __future__ import annotations

from functools import partial
from typing import Any

import numpy as np

from engine.errors import CellError
from engine.messages import Pose
from robots.model.transform import RigidTransform
from robots.port import Array
from robots.scene.sim_scene import SimScene
from robots.sim.loop.image_layout import ImageLayout
from robots.sim.physics.cell_model import build_cell
from robots.sim.physics.module_fixtures import POSE_FIELDS, ModuleFixtures, read_pose
from robots.sim.physics.physics import mujoco, place_fixed
from robots.vision.known_geometry import ArmConfiguration, MeasuredState


class PhysicsCopy:
    """MuJoCo's model of a scene and one state; raises CellError as `build_cell` does.

    `model` and `data` are MuJoCo's, for renderers.
    """

    def __init__(self, scene: SimScene) -> None:
        cell = build_cell(scene)
        self.model: Any = cell.model
        self.data: Any = mujoco.MjData(self.model)
        self._kind: Any = mujoco.mjtState.mjSTATE_INTEGRATION
        self._modules = [ModuleFixtures.of(cell, module) for module in scene.modules]
        layout = ImageLayout(
            (),
            state_size=int(mujoco.mj_stateSize(self.model, self._kind)),
            modules_size=POSE_FIELDS * len(self._modules),
        )
        self._physics, self._poses = layout.physics, layout.modules
        self._last_poses: Array = np.zeros(0)
        self.still_version = 0
        """Increases whenever what cannot move by itself stands elsewhere: modules come and go."""
        for module, bodies in zip(self._modules, scene.modules, strict=True):
            self._put(module, RigidTransform.from_pose(bodies.at) if bodies.plugged else None)
        mujoco.mj_kinematics(self.model, self.data)
        self._parts = cell.parts
        self._part_qpos = cell.part_qpos
        self._arms = {
            arm.name: (arm.qpos, _tool_joints(self.model, arm.name, frozenset(arm.model.arm_joints)))
            for arm in cell.arms
        }

    def go_to(self, image: Array) -> None:
        """Set the state of `image`, from `WorldHost.image`; raises CellError if it is not of this world."""
        if len(image) < self._poses.stop or not np.isfinite(image[self._physics]).all():
            raise CellError(f"{len(image)} numbers are not a state of this world", where="cameras")
        poses = image[self._poses]
        if not np.array_equal(poses, self._last_poses):
            self._last_poses = poses.copy()
            self.still_version += 1
            for module, numbers in zip(self._modules, poses.reshape(-1, POSE_FIELDS), strict=True):
                self._put(module, read_pose(numbers))
        mujoco.mj_setState(self.model, self.data, np.ascontiguousarray(image[self._physics]), self._kind)
        mujoco.mj_kinematics(self.model, self.data)

    def _put(self, module: ModuleFixtures, pose: RigidTransform | None) -> None:
        module.put(pose, place=partial(place_fixed, self.model))

    def moment(self, time_s: float) -> MeasuredState:
        """Return the configurations of arms and poses of parts in this state."""
        q: Array = self.data.qpos
        return MeasuredState(
            time_s=time_s,
            arms={
                name: ArmConfiguration(
                    joints=tuple(q[places].tolist()),
                    tool_joints={joint: float(q[place]) for joint, place in tool.items()},
                )
                for name, (places, tool) in self._arms.items()
            },
            parts=dict(zip(self._parts, map(_pose, q[self._part_qpos].reshape(-1, 7)), strict=True)),
        )


def _tool_joints(model: Any, arm: str, arm_joints: frozenset[str]) -> dict[str, int]:
    """Return the addresses of the joints of an arm's tool, by their names in the URDF."""
    prefix = f"{arm}/"
    joints = (model.joint(number) for number in range(int(model.njnt)))
    named = {str(joint.name).removeprefix(prefix): joint for joint in joints if str(joint.name).startswith(prefix)}
    return {name: int(joint.qposadr[0]) for name, joint in named.items() if name not in arm_joints}


def _pose(numbers: Array) -> Pose:
    return RigidTransform.of(numbers[:3], np.roll(numbers[3:], -1)).to_pose("world")
