"""The kind of tool `gripper`, as the table of tool kinds lists it."""

from __future__ import annotations

from engine.cell import ToolKind
from engine.messages import GripperState
from engine.skills.gripper import GripperOpen

GRIPPER = ToolKind(
    name="gripper",
    measured=GripperState,
    hold="gripper.Grasp",
    release="gripper.Open",
    check="gripper.CheckHeld",
    release_goal=GripperOpen(),
    mechanisms={
        "parallel": "robots.model.finger_mechanisms:GripperModel",
        "linkage": "robots.model.finger_mechanisms:LinkageModel",
        "claw": "robots.model.finger_mechanisms:ClawModel",
    },
    simulation="robots.standard_tools.gripper_simulation:GRIPPER_SIMULATION",
    switched="robots.standard_tools.switched_gripper:SWITCHED_GRIPPER_KIND",
)
