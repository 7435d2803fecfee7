"""Robot models as data: an arm's folder and a tool's folder become one URDF with joints, limits and licence."""

from robots.model.finger_mechanisms import ClawModel, GripperModel, LinkageModel
from robots.model.hand_mechanism import SynergyJoint, SynergyModel
from robots.model.mechanism import Mechanism, PadBox
from robots.model.registry import OWN_TOOL, model_by_name, robot_model, robot_names, tool_names
from robots.model.robot_model import JointLimits, RobotModel
from robots.model.tool_model import ToolModel

__all__ = [
    "OWN_TOOL",
    "ClawModel",
    "GripperModel",
    "JointLimits",
    "LinkageModel",
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
