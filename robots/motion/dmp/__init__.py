"""Dynamic movement primitives: integration, learning, planning, and offsets learned from force control.

The formulas are those of Ijspeert et al. 2013 (joints and positions) and Ude et al. 2014 (orientations),
with the parameters of RCL tables 6 to 8; see `docs/concepts/movement-primitives.md`.
"""

from robots.motion.dmp.integration import GoalChange, JointPath, PosePath, integrate_joints, integrate_pose
from robots.motion.dmp.kernels import GaussianKernels, phase_at
from robots.motion.dmp.learning import learn_cart_dmp, learn_joint_dmp
from robots.motion.dmp.offsets import no_offsets, offsets_at, offsets_from_samples, wrench_at
from robots.motion.dmp.online_execution import OnlineCartDmp, OnlineJointDmp, PhaseStopping
from robots.motion.dmp.plan_cart import plan_cart_dmp
from robots.motion.dmp.plan_joint import plan_joint_dmp
from robots.motion.dmp.task_frame import joints_in_task_frame, poses_in_task_frame, transform_dmp

__all__ = [
    "GaussianKernels",
    "GoalChange",
    "JointPath",
    "OnlineCartDmp",
    "OnlineJointDmp",
    "PhaseStopping",
    "PosePath",
    "integrate_joints",
    "integrate_pose",
    "joints_in_task_frame",
    "learn_cart_dmp",
    "learn_joint_dmp",
    "no_offsets",
    "offsets_at",
    "offsets_from_samples",
    "phase_at",
    "plan_cart_dmp",
    "plan_joint_dmp",
    "poses_in_task_frame",
    "transform_dmp",
    "wrench_at",
]
