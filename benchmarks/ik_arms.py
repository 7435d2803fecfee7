"""The arms of the benchmark of inverse kinematics, at a place in a cell, and reachable poses of their tools."""

from __future__ import annotations

import re
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from robots.model.mechanics.kinematics import ArmKinematics
from robots.model.registry import ARMS_DIR, robot_model
from robots.model.robot_model import RobotModel
from robots.model.transform import RigidTransform
from robots.port import Array

BASE = RigidTransform.of((-0.55, 0.1, 0.2), (0.0, 0.1, 0.3, 1.0))
CALIBRATION = ARMS_DIR / "ur10" / "ur10_calibration.yaml"


@dataclass(frozen=True, kw_only=True)
class Request:
    """A pose that the tool reaches with the joints within their limits, and where the arm is when asked."""

    target: RigidTransform
    seed: Array


def arms(folder: Path) -> dict[str, ArmKinematics]:
    """Return the arms by title; `folder` takes a calibration file."""
    models = {
        "Panda": robot_model("panda"),
        "UR10": robot_model("ur10"),
        "UR10, calibration file of the lab": robot_model("ur10", calibration=CALIBRATION),
        "UR10, calibrated by ±1 mm, ±1 mrad": calibrated_ur10(folder, size=1e-3),
        "IRB4600": robot_model("irb4600"),
    }
    return {title: ArmKinematics(model, base=BASE) for title, model in models.items()}


def calibrated_ur10(folder: Path, *, size: float) -> RobotModel:
    """Return a UR10 every number of whose calibration is off by a normal error of `size` metres or radians."""
    random = np.random.default_rng(5)

    def off(number: re.Match[str]) -> str:
        return f"{number[1]}: {float(number[2]) + random.normal() * size!r}"

    text = re.sub(r"\b(x|y|z|roll|pitch|yaw): (-?[\d.e+-]+)", off, CALIBRATION.read_text(encoding="utf-8"))
    file = folder / f"calibration_{size:g}.yaml"
    file.write_text(text, encoding="utf-8")
    return robot_model("ur10", calibration=file)


def requests(kinematics: ArmKinematics, count: int, *, seed: int = 1) -> list[Request]:
    """Return random requests: target and seed from configurations evenly drawn within the limits."""
    random = np.random.default_rng(seed)
    lower, upper = np.array(kinematics.limits.lower_rad), np.array(kinematics.limits.upper_rad)
    return [
        Request(target=kinematics.tool_pose(random.uniform(lower, upper)), seed=random.uniform(lower, upper))
        for _ in range(count)
    ]


def solves(kinematics: ArmKinematics, target: RigidTransform, joints: Array) -> bool:
    """Return whether joints put the tool within 10 µm and 0.1 mrad of the target, within the limits."""
    lower, upper = np.array(kinematics.limits.lower_rad), np.array(kinematics.limits.upper_rad)
    pose = kinematics.tool_pose(joints)
    near = pose.distance_m(target) <= 1e-5 and pose.angle_rad(target) <= 1e-4
    return near and bool(((joints >= lower) & (joints <= upper)).all())
