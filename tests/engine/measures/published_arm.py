"""An arm that publishes what a real one does: it turns at a known rate, and its tool moves on a known circle."""

from __future__ import annotations

import math

from engine.bus import SkillBus
from engine.messages import FramePoses, JointState, Pose, RobotDescription, Wrench
from engine.skills.arm_control import ArmStatus, ControlSettings

RADIUS_M = 0.5
RATE_RAD_S = 0.4


def describe(bus: SkillBus, arm: str = "left", *, tool_xyz_m: tuple[float, float, float] = (0.0, 0.0, 0.0)) -> None:
    """Publish description and status."""
    bus.topic(f"{arm}/description", RobotDescription).publish(
        RobotDescription(
            name=arm,
            model="turner",
            urdf="",
            joint_names=("turn",),
            lower_rad=(-3.0,),
            upper_rad=(3.0,),
            velocity_rad_s=(1.0,),
            acceleration_rad_s2=(1.0,),
            base=Pose(xyz=(0.0, 0.0, 0.0)),
            tool_frame=f"{arm}/tool",
        )
    )
    bus.topic(f"{arm}/status", ArmStatus).publish(
        ArmStatus(
            mode="idle",
            settings=ControlSettings(tool_xyz_m=tool_xyz_m),
            external_nm=(),
            wrench=Wrench(force_n=(0.0, 0.0, 0.0), torque_nm=(0.0, 0.0, 0.0), frame="world"),
        )
    )


def turn(bus: SkillBus, time_s: float, arm: str = "left", *, noise_rad: float = 0.0) -> None:
    """Publish where its joint is at a time."""
    angle_rad = RATE_RAD_S * time_s + noise_rad
    bus.topic(f"{arm}/joint_state", JointState).publish(
        JointState(
            time_s=time_s,
            names=("turn",),
            position_rad=(angle_rad,),
            velocity_rad_s=(RATE_RAD_S,),
            effort_nm=(0.0,),
        )
    )


def place(bus: SkillBus, time_s: float, arm: str = "left") -> None:
    """Publish where its tool link is at a time: on the circle, with its x axis outwards."""
    angle_rad = RATE_RAD_S * time_s
    xyz = (RADIUS_M * math.cos(angle_rad), RADIUS_M * math.sin(angle_rad), 0.3)
    xyzw = (0.0, 0.0, math.sin(angle_rad / 2), math.cos(angle_rad / 2))
    poses = FramePoses(time_s=time_s, names=("part", f"{arm}/tool"), xyz=((9.0, 9.0, 9.0), xyz), xyzw=(xyzw, xyzw))
    bus.topic("cell/frames", FramePoses).publish(poses)


def press(bus: SkillBus, force_n: float, torque_nm: float, arm: str = "left") -> None:
    """Publish what presses on its tool."""
    wrench = Wrench(force_n=(0.6 * force_n, 0.0, 0.8 * force_n), torque_nm=(0.0, -torque_nm, 0.0), frame="world")
    bus.topic(f"{arm}/wrench", Wrench).publish(wrench)
