"""Words for the addresses of skills, in causes and wherever people read who did what."""

from __future__ import annotations

import re

ARM_SKILL_TITLES = {
    "joint_trap_vel": "move to joints",
    "cart_trap_vel": "move to a pose",
    "cart_lin_task": "line to a pose",
    "forward_kinematics": "forward kinematics",
    "inverse_kinematics": "inverse kinematics",
    "all_inverse_kinematics": "all inverse kinematics",
    "plan_motion": "plan a motion",
    "execute_plan": "execute a plan",
    "move_free": "collision-free motion",
    "move_until_contact": "move until contact",
    "joint_dmp": "joint primitive",
    "cart_dmp": "Cartesian primitive",
    "cart_admit_dmp": "force-controlled primitive",
    "learn_joint_dmp": "learn a joint primitive",
    "learn_cart_dmp": "learn a Cartesian primitive",
    "prepare_jog": "prepare jogging",
    "jog_joints": "jog joints",
    "jog_tool": "jog the tool",
    "step_joints": "step joints",
    "step_tool": "step the tool",
    "guide_arm": "hand guiding",
    "finish_guiding": "end hand guiding",
    "switch_direct_control": "direct control",
    "trace_motion": "trace a motion",
    "read_arm": "read the state",
    "set_speed_override": "set the speed override",
    "set_controller": "set the controller",
    "set_joint_impedance": "set the joint impedance",
    "set_cartesian_impedance": "set the Cartesian impedance",
    "set_end_effector_frame": "set the end effector frame",
    "set_load": "set the load",
    "set_collision_behavior": "set the collision behavior",
    "recover_from_error": "recover from an error",
}
"""The skills that arms serve under their own name; those of other devices are words already: `grasp`, `attach_part`."""

_ADDRESS = re.compile(r"(?!root/)[A-Za-z]\w*(?:/[A-Za-z]\w*)+")
_ARM = re.compile(r"(?:^|_)arm(?:_|\d|$)")


def skill_words(address: str) -> str:
    """Return device and skill of an address in words: `left arm: line to a pose`, `left gripper: grasp`.

    Empty for what is no address, such as the path of a node or a position in a file.
    """
    if not _ADDRESS.fullmatch(address):
        return ""
    owner, *tools, name = address.split("/")
    title = ARM_SKILL_TITLES.get(name)
    if title is not None and not tools:
        return f"{owner}: {title}" if _ARM.search(owner) else f"{owner} arm: {title}"
    name = name.removeprefix(f"{tools[-1]}_") if tools else name
    return f"{' '.join([owner, *tools])}: {name.replace('_', ' ')}"
