"""A sensible goal of every motion skill of a Panda near its home configuration, drawn by a random generator."""

from __future__ import annotations

import random
from collections.abc import Callable
from typing import Any

import numpy as np

from engine.messages import Pose
from engine.messages.primitives import CartDmp, ForceReference, JointDmp
from engine.skill import Action
from engine.skills.contact import MoveUntilContact
from engine.skills.dmp import CartAdmitDMP, CartDMP, Compliance, JointDMP
from engine.skills.guiding import GuideArm
from engine.skills.identification import IdentifyFriction, IdentifyPayload
from engine.skills.jogging import JogJoints, JogTool, StepJoints, StepTool
from engine.skills.motion import CartLinTask, CartTrapVel, JointTrapVel
from engine.skills.waypoints import FollowWaypoints, Waypoint
from robots.model.transform import RigidTransform
from robots.port import Array
from tests.robots.panda_arm import home, panda_kinematics, panda_model

Maker = Callable[[Array, random.Random], Action[Any, Any]]


def some(random_: random.Random, size: float, count: int) -> tuple[float, ...]:
    """Return `count` numbers of at most `size`."""
    return tuple(random_.uniform(-size, size) for _ in range(count))


def near_home(random_: random.Random) -> tuple[float, ...]:
    """Return joints around home."""
    return tuple((home() + np.array(some(random_, 0.25, 7))).tolist())


def _tool(joints: Array) -> RigidTransform:
    return panda_kinematics().tool_pose(joints)


def _beside(joints: Array, random_: random.Random) -> Pose:
    tool = _tool(joints)
    return RigidTransform(xyz=tool.xyz + np.array(some(random_, 0.05, 3)), xyzw=tool.xyzw).to_pose("world")


def joint_dmp(start: Array, goal: tuple[float, ...], **changes: Any) -> JointDmp:
    """Return a primitive without a forcing term from `start`; `changes` replace its parameters."""
    values: dict[str, Any] = {
        "N": 2, "a_z": 20.0, "a_x": 2.0, "tau": 2.0, "goal": goal, "y0": tuple(start.tolist()), "dy0": (0.0,) * 7,
        "c": (1.0, 0.3), "sigma": (0.1, 0.1), "w": ((0.0, 0.0),) * 7,
    }  # fmt: skip
    return JointDmp(**(values | changes))


def cart_dmp(start: Array, **changes: Any) -> CartDmp:
    """Return a primitive that lifts the tool by 3 cm from `start` (joints); `changes` replace its parameters."""
    tool = _tool(start)
    x, y, z = tool.xyz.tolist()
    turn = tuple(tool.xyzw.tolist())
    values: dict[str, Any] = {
        "N": 2, "a_z": 20.0, "a_x": 2.0, "tau": 2.0, "goal": (x, y, z + 0.03, *turn), "y0": (x, y, z, *turn),
        "c": (1.0, 0.3), "sigma": (0.1, 0.1), **{f"w{row}": (0.0, 0.0) for row in range(1, 7)},
    }  # fmt: skip
    return CartDmp(**(values | changes))


def _pressing(start: Array, random_: random.Random) -> CartAdmitDMP:
    active = tuple(float(random_.random() < 0.5) for _ in range(6))
    force = ForceReference.constant(force_n=some(random_, 10.0, 3))
    compliance = Compliance(active=(active[0], active[1], active[2], active[3], active[4], active[5]))
    return CartAdmitDMP(dmp=cart_dmp(start), force=force, compliance=compliance, start_reach_m=0.1, start_reach_rad=0.5)


def _jog_joints(_: Array, random_: random.Random) -> JogJoints:
    if random_.random() < 0.5:
        return JogJoints(idle_s=random_.uniform(0.1, 1.0))
    return JogJoints(velocity_rad_s=some(random_, 0.5, 7), duration_s=random_.uniform(0.01, 1.0))


def _jog_tool(_: Array, random_: random.Random) -> JogTool:
    if random_.random() < 0.5:
        return JogTool(idle_s=random_.uniform(0.1, 1.0), frame=random_.choice(("world", "base", "tool")))
    return JogTool(velocity=some(random_, 0.1, 6), duration_s=random_.uniform(0.01, 1.0))


def _until_contact(_: Array, random_: random.Random) -> MoveUntilContact:
    x, y, z = some(random_, 1.0, 3)
    return MoveUntilContact(direction=(x, y, z), distance_m=0.03, speed_m_s=random_.uniform(0.02, 0.1))


def _step_tool(_: Array, random_: random.Random) -> StepTool:
    x, y, z = some(random_, 0.02, 3)
    return StepTool(step_m=(x, y, z), frame=random_.choice(("world", "base", "tool")))


def _through(now: Array, random_: random.Random) -> FollowWaypoints:
    through = (Waypoint(joints=near_home(random_), blend_m=random_.choice((0.0, 0.02))) for _ in range(3))
    return FollowWaypoints(waypoints=(Waypoint(pose=_beside(now, random_)), *through), speed=random_.uniform(0.2, 1.0))


MAKERS: tuple[Maker, ...] = (
    lambda _, random_: JointTrapVel(joints=near_home(random_), speed=random_.uniform(0.1, 1.0)),
    lambda now, random_: CartTrapVel(pose=_beside(now, random_), speed=0.5),
    lambda now, random_: CartLinTask(pose=_beside(now, random_), duration_s=random_.uniform(0.8, 2.0)),
    _through,
    lambda now, random_: JointDMP(dmp=joint_dmp(now, near_home(random_))),
    lambda now, _: CartDMP(dmp=cart_dmp(now), start_reach_m=0.1, start_reach_rad=0.5),
    _pressing,
    _jog_joints,
    _jog_tool,
    lambda _, random_: StepJoints(step_rad=some(random_, 0.1, 7), speed=0.5),
    _step_tool,
    _until_contact,
    lambda _, random_: IdentifyPayload(amplitude_rad=random_.uniform(0.1, 0.5)),
    lambda _, random_: IdentifyFriction(joints=(random_.choice(panda_model().arm_joints),), amplitude_rad=0.2),
    lambda _, random_: GuideArm(damping=random_.random(), duration_s=random_.choice((None, 0.5))),
)
"""One for each motion skill: from the measured joints and a random generator to a goal."""

LOWER, UPPER = np.array(panda_model().limits.lower_rad), np.array(panda_model().limits.upper_rad)
