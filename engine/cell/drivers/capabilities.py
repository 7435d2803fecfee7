"""What a driver can do, and which skills need it: the table of capabilities."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Literal

Capability = Literal["trajectory", "stream", "torque", "force", "guide", "reflex", "outputs", "gripper", "hand"]

CAPABILITIES: Mapping[Capability, str] = {
    "trajectory": "sampled trajectories",
    "stream": "streamed set points",
    "torque": "impedance control",
    "force": "force control",
    "guide": "hand guiding",
    "reflex": "the collision reflex",
    "outputs": "digital outputs",
    "gripper": "gripper commands",
    "hand": "hand commands",
}
"""Each capability in words, as messages say it."""

SKILL_CAPABILITIES: Mapping[str, Capability] = {
    **dict.fromkeys(
        (
            "joint_trap_vel", "cart_trap_vel", "cart_lin_task", "follow_waypoints", "execute_plan", "move_free",
            "move_until_contact", "joint_dmp", "cart_dmp", "step_joints", "step_tool", "identify_payload",
            "identify_friction",
        ),
        "trajectory",
    ),
    **dict.fromkeys(("jog_joints", "jog_tool", "switch_direct_control"), "stream"),
    **dict.fromkeys(("set_controller", "set_joint_impedance", "set_cartesian_impedance"), "torque"),
    "cart_admit_dmp": "force",
    **dict.fromkeys(("guide_arm", "finish_guiding"), "guide"),
    "set_collision_behavior": "reflex",
    **dict.fromkeys(("set_output", "set_tool_exchange", "set_gripper", "set_linear_axis"), "outputs"),
    **dict.fromkeys(("gripper_open", "gripper_move", "gripper_grasp", "read_gripper"), "gripper"),
    **dict.fromkeys(("hand_open", "hand_close", "read_hand"), "hand"),
}  # fmt: skip
"""Name of a skill → what the driver of the device must be able to do."""
