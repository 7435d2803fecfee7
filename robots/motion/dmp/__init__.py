"""Dynamic movement primitives: roll-out, learning, planning, and offsets learned from force control.

The formulas are those of Ijspeert et al. 2013 (joints and positions) and Ude et al. 2014 (orientations),
with the parameters of RCL tables 6 to 8; see `docs/concepts/movement-primitives.md`.
"""

from robots.motion.dmp.kernels import Kernels, phase_at
from robots.motion.dmp.learning import learn_cart_dmp, learn_joint_dmp
from robots.motion.dmp.offsets import no_offsets, offsets_at, offsets_from_samples, wrench_at
from robots.motion.dmp.plan_cart import plan_cart_dmp
from robots.motion.dmp.plan_joint import plan_joint_dmp
from robots.motion.dmp.roll_out import GoalChange, JointPath, PosePath, roll_out_joints, roll_out_pose
from robots.motion.dmp.running import PhaseStopping, RunningCartDmp, RunningJointDmp
from robots.motion.dmp.task_frame import joints_in_task_frame, moved, poses_in_task_frame

__all__ = [
    "GoalChange",
    "JointPath",
    "Kernels",
    "PhaseStopping",
    "PosePath",
    "RunningCartDmp",
    "RunningJointDmp",
    "joints_in_task_frame",
    "learn_cart_dmp",
    "learn_joint_dmp",
    "moved",
    "no_offsets",
    "offsets_at",
    "offsets_from_samples",
    "phase_at",
    "plan_cart_dmp",
    "plan_joint_dmp",
    "poses_in_task_frame",
    "roll_out_joints",
    "roll_out_pose",
    "wrench_at",
]
