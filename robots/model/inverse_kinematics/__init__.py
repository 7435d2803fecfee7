"""Inverse kinematics of any serial arm: nearest and all solutions within joint limits, tracking, postures.

`InverseKinematicsSolver` is the public interface. `chain` derives an arm's parameters from its forward kinematics,
`ideal_arm` and `analytic` solve six-axis arms in closed form, `kernels` contains the compiled descents,
`configuration_quality` detects singularities, `failure_reason` explains failures.
"""

from robots.model.inverse_kinematics.configuration_quality import SINGULAR, ConfigurationQuality
from robots.model.inverse_kinematics.differential import pose_error, weighted_step
from robots.model.inverse_kinematics.fast_kinematics import ANGLE_TOLERANCE_RAD, POSITION_TOLERANCE_M
from robots.model.inverse_kinematics.pose_match import PoseMatch
from robots.model.inverse_kinematics.solutions import SolutionSet
from robots.model.inverse_kinematics.solver import InverseKinematicsSolver, JointSolution

__all__ = [
    "ANGLE_TOLERANCE_RAD",
    "POSITION_TOLERANCE_M",
    "SINGULAR",
    "ConfigurationQuality",
    "InverseKinematicsSolver",
    "JointSolution",
    "PoseMatch",
    "SolutionSet",
    "pose_error",
    "weighted_step",
]
