"""Inverse kinematics of any serial arm: nearest and all solutions within joint limits, following, postures.

`InverseKinematicsSolver` is what others use. `chain` takes an arm's numbers from its forward kinematics,
`ideal_arm` and `analytic` solve six-axis arms in closed form, `kernels` holds the compiled descents,
`configuration_quality` tells singularities, `failure_reason` the reason why not.
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
