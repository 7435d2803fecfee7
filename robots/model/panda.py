"""Franka Emika Panda with the Franka Hand, from the package example-robot-data.

Limits are those of the vendor's interface documentation ("Robot and interface specifications",
joint space limits of the Panda); the hand's from its product manual.
"""

from __future__ import annotations

from robots.model.description import disabled_collisions, installed_share_dir
from robots.model.robot_model import GripperModel, JointLimits, PadBox, RobotModel

_PACKAGE = "example-robot-data"
_FOLDER = "example-robot-data/robots/panda_description"

# Measured on the fingertip of the description's mesh: 17.5 mm wide, 18.5 mm high rubber tip, face at y = 0.
_PAD_SIZE_M = (0.0175, 0.012, 0.0185)
_PAD_Z_M = 0.04525


def panda() -> RobotModel:
    """Return the Panda; raises CellError when its description is not installed."""
    share = installed_share_dir(package=_PACKAGE, marker=f"{_FOLDER}/urdf/panda.urdf")
    folder = share / _FOLDER
    return RobotModel(
        name="panda",
        urdf=folder / "urdf" / "panda.urdf",
        collision_urdf=folder / "urdf" / "panda_collision.urdf",
        package_dir=share,
        base_link="panda_link0",
        arm_joints=tuple(f"panda_joint{i}" for i in range(1, 8)),
        limits=JointLimits(
            lower_rad=(-2.8973, -1.7628, -2.8973, -3.0718, -2.8973, -0.0175, -2.8973),
            upper_rad=(2.8973, 1.7628, 2.8973, -0.0698, 2.8973, 3.7525, 2.8973),
            velocity_rad_s=(2.175, 2.175, 2.175, 2.175, 2.61, 2.61, 2.61),
            acceleration_rad_s2=(15.0, 7.5, 10.0, 12.5, 15.0, 20.0, 20.0),
            jerk_rad_s3=(7500.0, 3750.0, 5000.0, 6250.0, 7500.0, 10000.0, 10000.0),
            effort_nm=(87.0, 87.0, 87.0, 87.0, 12.0, 12.0, 12.0),
        ),
        tool_link="panda_hand_tcp",
        home_rad=(0.0, -0.785398163, 0.0, -2.35619449, 0.0, 1.570796327, 0.785398163),
        gripper=_hand(),
        allowed_collisions=disabled_collisions(folder / "srdf" / "panda.srdf"),
        licence="Apache-2.0",
        licence_file=folder / "LICENSE",
    )


def _hand() -> GripperModel:
    left, right = "panda_leftfinger", "panda_rightfinger"
    half_thickness = _PAD_SIZE_M[1] / 2
    return GripperModel(
        name="panda_hand",
        hand_link="panda_hand",
        finger_joints=("panda_finger_joint1", "panda_finger_joint2"),
        finger_links=(left, right),
        pads=(
            PadBox(link=left, xyz=(0.0, half_thickness, _PAD_Z_M), size_m=_PAD_SIZE_M),
            PadBox(link=right, xyz=(0.0, -half_thickness, _PAD_Z_M), size_m=_PAD_SIZE_M),
        ),
        max_width_m=0.08,
        max_speed_m_s=0.2,
        max_force_n=140.0,
    )
