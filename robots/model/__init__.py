"""Robot models as data: an arm's folder and a tool's folder become one URDF with joints, limits and licence."""

from robots.model.registry import OWN_TOOL, model_by_name, robot_model, robot_names, tool_names
from robots.model.robot_model import GripperModel, JointLimits, PadBox, RobotModel
from robots.model.tool_model import (
    ClawModel,
    LinkageModel,
    MagnetModel,
    Mechanism,
    SynergyJoint,
    SynergyModel,
    ToolModel,
)

__all__ = [
    "OWN_TOOL",
    "ClawModel",
    "GripperModel",
    "JointLimits",
    "LinkageModel",
    "MagnetModel",
    "Mechanism",
    "PadBox",
    "RobotModel",
    "SynergyJoint",
    "SynergyModel",
    "ToolModel",
    "model_by_name",
    "robot_model",
    "robot_names",
    "tool_names",
]
