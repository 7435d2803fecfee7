"""Robot models as data: where their descriptions lie, their joints, limits, tools and grippers."""

from robots.model.registry import model_by_name
from robots.model.robot_model import GripperModel, JointLimits, PadBox, RobotModel

__all__ = ["GripperModel", "JointLimits", "PadBox", "RobotModel", "model_by_name"]
