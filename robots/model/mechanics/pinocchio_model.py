"""Pinocchio models of a robot: the complete one, and the arm with the tool's joints locked."""

from __future__ import annotations

from importlib import import_module
from typing import Any

import numpy as np

from engine.errors import CellError
from robots.model.robot_model import RobotModel

# pinocchio has no type stubs, and its wheel installs it where type checkers do not look: its users return
# numpy arrays.
pin: Any = import_module("pinocchio")


def whole_model(model: RobotModel) -> Any:
    """Return the model of arm and tool with all joints.

    Raises:
        CellError: the URDF lacks a joint or the tool link, or has the joints in another order.
    """
    full = pin.buildModelFromXML(model.urdf_text)
    for joint in model.arm_joints:
        if not full.existJointName(joint):
            raise CellError(f"the URDF has no joint {joint}", where=model.name, hint="correct the robot model")
    if not full.existFrame(model.tool_link):
        raise CellError(f"the URDF has no link {model.tool_link}", where=model.name, hint="correct the robot model")
    return full


def locked_joints(full: Any, model: RobotModel) -> list[int]:
    """Return the numbers of the joints that are not the arm's."""
    return [full.getJointId(name) for name in list(full.names)[1:] if name not in model.arm_joints]


def arm_model(model: RobotModel) -> Any:
    """Return the arm with the tool's joints locked at 0; raises CellError as `whole_model` does."""
    full = whole_model(model)
    reduced = pin.buildReducedModel(full, locked_joints(full, model), pin.neutral(full))
    if tuple(reduced.names)[1:] != model.arm_joints:
        raise CellError("the joints of the robot model are not in the order of the URDF", where=model.name)
    return reduced


def rest_configuration(full: Any, model: RobotModel) -> Any:
    """Return the configuration of a whole model with the arm at home and the tool's joints at 0."""
    q = np.array(pin.neutral(full))
    for name, angle in zip(model.arm_joints, model.home_rad, strict=True):
        q[full.joints[full.getJointId(name)].idx_q] = angle
    return q
