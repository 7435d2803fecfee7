"""Typed messages of the bus: geometry, robots, sensing and learned motion.

SI units, quaternions x y z w, angles in radians. Imports nothing else of the engine.
Files of other subjects (shapes, sensing, demonstrations, primitives, pose algebra) are faces of their own, loaded by
those who use them.
"""

from engine.messages.geometry import (
    DRAWN_ONLY,
    FramePoses,
    Message,
    PartPoses,
    Pose,
    Quaternion,
    Vector3,
    Vector6,
    Wrench,
)
from engine.messages.robot_states import (
    ExternalTorque,
    GripperState,
    HandState,
    HoldEvidence,
    JointSetPoint,
    JointState,
    RobotDescription,
)
from engine.messages.scene import SceneDescription, VisualGeometry

__all__ = [
    "DRAWN_ONLY",
    "ExternalTorque",
    "FramePoses",
    "GripperState",
    "HandState",
    "HoldEvidence",
    "JointSetPoint",
    "JointState",
    "Message",
    "PartPoses",
    "Pose",
    "Quaternion",
    "RobotDescription",
    "SceneDescription",
    "Vector3",
    "Vector6",
    "VisualGeometry",
    "Wrench",
]
