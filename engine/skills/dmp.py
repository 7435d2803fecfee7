"""Skills on dynamic movement primitives of one arm, served under the arm's name (RCL 4.3.5 to 4.3.7, RCY 7.1).

The parameters are those of RCL tables 6 to 8, see `engine.messages.primitives`. After a preempted or failed goal
the arm is at rest and ready for the next goal.
"""

from __future__ import annotations

from typing import Annotated, ClassVar

import msgspec

from engine.messages import Message, Pose, Vector6, Wrench
from engine.messages.demonstrations import Trajectory
from engine.messages.primitives import CartDmp, CartOffsets, ForceReference, JointDmp
from engine.skill import Action, Capability, Service
from engine.skills.axes import Axes
from engine.skills.collision_options import CollisionOptions
from engine.skills.motion import CartMotionFeedback, CartMotionResult, JointMotionFeedback, JointMotionResult

Kernels = Annotated[int, msgspec.Meta(ge=0, le=184, description="Number of kernels N; 0 selects it by the fit")]
GainZ = Annotated[float, msgspec.Meta(gt=0, description="Gain of the transformation system")]
GainX = Annotated[float, msgspec.Meta(gt=0, description="Gain of the phase")]


class JointDMP(Action[JointMotionResult, JointMotionFeedback], frozen=True, kw_only=True):
    """Move along a joint-space DMP (RCL table 6).

    Rejected before the motion, with the reason, when the arm is more than `start_reach_rad` from the
    primitive's start `y0`, or a joint would exceed its position, speed or acceleration limits. A smaller
    distance fades out during the motion. `goal` replaces the primitive's goal smoothly; empty for none.
    """

    capability: ClassVar[Capability] = "trajectory"

    dmp: JointDmp
    goal: tuple[float, ...] = ()
    start_reach_rad: Annotated[float, msgspec.Meta(ge=0.0)] = 0.1
    collisions: CollisionOptions = CollisionOptions()


class CartDMP(Action[CartMotionResult, CartMotionFeedback], frozen=True, kw_only=True):
    """Move the tool centre point along a Cartesian DMP (RCL table 7).

    Rejected before the motion, with the reason, when the tool is farther from the primitive's start than
    the two reaches, or the arm cannot follow the motion. `goal` replaces the primitive's goal smoothly.
    """

    capability: ClassVar[Capability] = "trajectory"

    dmp: CartDmp
    goal: Pose | None = None
    start_reach_m: Annotated[float, msgspec.Meta(ge=0.0)] = 0.03
    start_reach_rad: Annotated[float, msgspec.Meta(ge=0.0)] = 0.2
    collisions: CollisionOptions = CollisionOptions()


class Compliance(Message, frozen=True, kw_only=True):
    """M ẍ + D ẋ + K x = F_measured - F_wanted for the offset x, for each axis: along x y z, then about x y z.

    An axis with `active` 0 follows the path, one with 1 the force. Masses are kg and kg m²,
    damping N s/m and N m s/rad, stiffness N/m and N m/rad (0: pure force control). `frame` selects the
    axes of the task frame: those of the world, of the arm's base, or of the tool at the start of
    the motion. The offset stays within `reach_m` and `turn_rad`, its speed within `speed_m_s`
    and `turn_rad_s`. As long as no force is felt along an axis on which one is wanted, the force moves the tool no
    faster than `touch_m_s`, which limits the peak of the first touch.
    """

    active: Vector6 = (0.0, 0.0, 1.0, 0.0, 0.0, 0.0)
    mass: Vector6 = (4.0, 4.0, 4.0, 0.2, 0.2, 0.2)
    damping: Vector6 = (300.0, 300.0, 300.0, 10.0, 10.0, 10.0)
    stiffness: Vector6 = (0.0, 0.0, 0.0, 0.0, 0.0, 0.0)
    frame: Axes = "world"
    reach_m: Annotated[float, msgspec.Meta(gt=0.0)] = 0.05
    turn_rad: Annotated[float, msgspec.Meta(gt=0.0)] = 0.3
    speed_m_s: Annotated[float, msgspec.Meta(gt=0.0)] = 0.1
    touch_m_s: Annotated[float, msgspec.Meta(gt=0.0)] = 0.01
    turn_rad_s: Annotated[float, msgspec.Meta(gt=0.0)] = 0.5

    def __post_init__(self) -> None:
        if any(not 0.0 <= share <= 1.0 for share in self.active):
            raise ValueError("`active` is from 0 to 1 for each axis")
        if min(self.mass) < 0.0 or min(self.damping) <= 0.0 or min(self.stiffness) < 0.0:
            raise ValueError("`mass` and `stiffness` are at least 0, `damping` is above 0, for each axis")


class CartAdmitFeedback(Message, frozen=True, kw_only=True):
    """The measured wrench on the tool (world axes) and the pose of the tool (RCL table 8)."""

    wrench: Wrench
    pose: Pose
    progress: float


class CartAdmitResult(Message, frozen=True, kw_only=True):
    """The result of a learning pass (RCL table 8): pass `offsets` to the next one; None after an interrupted pass.

    The force errors are newton, over the whole pass and the active axes x, y and z together; 0 after a failed pass.
    """

    offsets: CartOffsets | None
    pose: Pose
    force_error_rms_n: float
    force_error_max_n: float
    duration_s: float


class CartAdmitDMP(Action[CartAdmitResult, CartAdmitFeedback], frozen=True, kw_only=True):
    """Move along a Cartesian DMP with the reference `force` by admittance; return the learned offsets (RCL table 8).

    `offsets` of an earlier pass are added from the start, limited to the reach; None for zero.
    `slow_per_n` sets the phase stopping: the motion slows to 1 / (1 + slow_per_n · |force error|). `N`
    kernels encode the offsets.
    """

    capability: ClassVar[Capability] = "force"

    dmp: CartDmp
    offsets: CartOffsets | None = None
    force: ForceReference
    compliance: Compliance = Compliance()
    slow_per_n: Annotated[float, msgspec.Meta(ge=0.0)] = 0.0
    N: Kernels = 0
    start_reach_m: Annotated[float, msgspec.Meta(ge=0.0)] = 0.03
    start_reach_rad: Annotated[float, msgspec.Meta(ge=0.0)] = 0.2
    collisions: CollisionOptions = CollisionOptions()


class TrimInterval(Message, frozen=True, kw_only=True):
    """The used interval of a recording: from `start_s` to `end_s` after its first sample."""

    start_s: float
    end_s: float


class JointFit(Message, frozen=True, kw_only=True):
    """The error of a learned joint DMP against its recording: RMS, maximum, and at the goal.

    `joint` is the index of the joint with the greatest error, from 0. `rms_m` and `max_m` are the resulting errors
    of the tool centre point, None when it is not known which arm.
    """

    kernels: int
    rms_rad: float
    max_rad: float
    end_rad: float
    joint: int
    cut: TrimInterval
    rms_m: float | None = None
    max_m: float | None = None


class CartFit(Message, frozen=True, kw_only=True):
    """The error of a learned Cartesian DMP against its recording: RMS, maximum, and at the goal."""

    kernels: int
    rms_m: float
    max_m: float
    end_m: float
    rms_rad: float
    max_rad: float
    end_rad: float
    cut: TrimInterval


class LearnedJointDmp(Message, frozen=True, kw_only=True):
    """A joint DMP and its fit."""

    dmp: JointDmp
    fit: JointFit


class LearnedCartDmp(Message, frozen=True, kw_only=True):
    """A Cartesian DMP and its fit."""

    dmp: CartDmp
    fit: CartFit


class RecordedMotion(msgspec.Struct, frozen=True, kw_only=True):
    """What a DMP is learned from: the entry of kind `trajectory`, or `trajectory` itself.

    `trim` removes the time at rest at both ends.
    """

    entry: str = ""
    trajectory: Trajectory | None = None
    N: Kernels = 0
    a_z: GainZ = 48.0
    a_x: GainX = 2.0
    trim: bool = True

    def __post_init__(self) -> None:
        if bool(self.entry) == (self.trajectory is not None):
            raise ValueError("give either `entry` or `trajectory`")


class LearnJointDmp(RecordedMotion, Service[LearnedJointDmp], frozen=True, kw_only=True):
    """Learn a joint DMP from a recorded motion."""


class LearnCartDmp(RecordedMotion, Service[LearnedCartDmp], frozen=True, kw_only=True):
    """Learn a Cartesian DMP from a recorded motion.

    The tool poses of a recording without them are computed by forward kinematics.
    """
