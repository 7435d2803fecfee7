"""Inverse kinematics of any serial arm: nearest and all solutions within joint limits, following, postures.

`InverseKinematics` is what others use. `chain` takes an arm's numbers from its forward kinematics,
`ideal` and `analytic` solve six-axis arms in closed form, `kernels` holds the compiled descents,
`posture` tells singularities, `unreachable` the reason why not.
"""

from robots.model.inverse_kinematics.differential import pose_error, weighted_step
from robots.model.inverse_kinematics.fast_arm import ANGLE_TOLERANCE_RAD, POSITION_TOLERANCE_M
from robots.model.inverse_kinematics.match import Match
from robots.model.inverse_kinematics.posture import SINGULAR, Posture
from robots.model.inverse_kinematics.solutions import Solutions
from robots.model.inverse_kinematics.solver import InverseKinematics, Solution

__all__ = [
    "ANGLE_TOLERANCE_RAD",
    "POSITION_TOLERANCE_M",
    "SINGULAR",
    "InverseKinematics",
    "Match",
    "Posture",
    "Solution",
    "Solutions",
    "pose_error",
    "weighted_step",
]
