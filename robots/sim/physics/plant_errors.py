"""What a simulated arm really is: its masses, friction, motors and base, drawn around the nominal ones.

A draw depends on the seed and on the name of what it is for, so adding an arm changes no other one.
"""

from __future__ import annotations

import zlib
from typing import Any

import numpy as np

from engine.messages import Pose
from robots.model.robot_model import RobotModel
from robots.model.transform import RigidTransform, product, quaternion_of
from robots.scene.realism import Realism, realism
from robots.scene.sim_scene import ArmPlacement, PartBody, SimScene

# Frames without a mass of their own stay without.
_MASSLESS_KG = 1e-6


class PlantErrors:
    """The errors of one world. Those of the preset `ideal` are all zero and change no bit.

    Args:
        scene: Its preset and its seed.
    """

    def __init__(self, scene: SimScene) -> None:
        self._preset: Realism = realism(scene.realism)
        self._ideal = scene.realism == "ideal"
        self._seed = scene.seed

    def base(self, arm: ArmPlacement) -> Pose:
        """Return where the base of an arm really stands."""
        if self._ideal:
            return arm.base
        draw = self._draws(f"{arm.name}/base")
        offset = draw.uniform(-1.0, 1.0, 3) * self._preset.base_m
        turn = draw.uniform(-1.0, 1.0, 3) * self._preset.base_rad
        nominal = RigidTransform.from_pose(arm.base)
        x, y, z = (nominal.xyz + offset).tolist()
        qx, qy, qz, qw = product(quaternion_of(turn), nominal.xyzw).tolist()
        return Pose(xyz=(x, y, z), xyzw=(qx, qy, qz, qw), frame=arm.base.frame)

    def mass_kg(self, part: PartBody) -> float:
        """Return what a part really weighs; of a tool what its plate does."""
        return part.mass_kg * self.mass_factor(part)

    def mass_factor(self, part: PartBody) -> float:
        """Return what the real masses of a part are multiplied with."""
        if self._ideal:
            return 1.0
        return 1.0 + self._preset.payload_spread * self._draws(f"{part.name}/mass").uniform(-1.0, 1.0)

    def apply(self, spec: Any, model: RobotModel, *, name: str) -> None:
        """Change the specification of the arm `name`: its links and those of its tool, and the joints of the arm."""
        if self._ideal:
            return
        for body in spec.bodies:
            if float(body.mass) > _MASSLESS_KG:
                self._change_link(body, self._draws(f"{name}/{body.name}"))
        for joint, effort_nm in zip(model.arm_joints, model.limits.effort_nm, strict=True):
            self._change_joint(spec.joint(joint), effort_nm, self._draws(f"{name}/{joint}"))

    def _change_link(self, body: Any, draw: np.random.Generator) -> None:
        scale = 1.0 + self._preset.link_mass_spread * draw.uniform(-1.0, 1.0)
        body.mass = float(body.mass) * scale
        body.inertia = np.array(body.inertia) * scale
        # NaN where the inertia is given by its main axes.
        body.fullinertia = np.array(body.fullinertia) * scale
        body.ipos = np.array(body.ipos) + self._preset.link_com_m * draw.uniform(-1.0, 1.0, 3)

    def _change_joint(self, joint: Any, effort_nm: float, draw: np.random.Generator) -> None:
        preset = self._preset
        inertia, coulomb, viscous = draw.uniform(-1.0, 1.0, 3).tolist()
        joint.armature = float(joint.armature) * (1.0 + preset.motor_inertia_spread * inertia)
        joint.frictionloss = preset.coulomb_share * effort_nm * (1.0 + preset.friction_spread * coulomb)
        joint.damping[0] += preset.viscous_share_s_rad * effort_nm * (1.0 + preset.friction_spread * viscous)

    def _draws(self, name: str) -> np.random.Generator:
        return np.random.default_rng([self._seed, zlib.crc32(name.encode())])
