"""The legs of a hexapod in MuJoCo's specification: tendons between two plates, each held by a stiff spring that slips.

A leg is elastic up to the force at which it slips, which `robots.sim.loop.hexapod_brakes` sets. Dry friction of MuJoCo
would let a loaded platform creep.
"""

from __future__ import annotations

import math
from typing import Any

from engine.messages import Pose
from engine.messages.pose_algebra import compose_poses, invert_pose
from robots.scene.sim_scene import FixtureBody
from robots.sim.physics.physics import mujoco
from robots.sim.physics.tool_body import PAD_SOLIMP, PAD_SOLREF

STIFFNESS_N_M = 2e5
"""Of a leg with its brake; a light platform on six of them is stable at steps of 1 ms."""


def leg_names(platform: str) -> tuple[str, ...]:
    """Return the names of the legs of a platform in the model."""
    return tuple(f"{platform}~leg_{number}" for number in range(1, 7))


def place_on(platform: FixtureBody, fixture: FixtureBody) -> Pose:
    """Return the pose of a fixture in the frame of another, which carries it, as both are at the start."""
    return compose_poses(invert_pose(platform.pose), fixture.pose)


def add_legs(spec: Any, platform: FixtureBody, base: FixtureBody) -> None:
    """Free a fixture in all directions, and hold it by six legs to its base.

    The control of a leg is by how much its spring is without force at another length than at the start.
    """
    legs, body = platform.hexapod, spec.body(platform.name)
    assert legs is not None
    for index, axis in enumerate(((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0))):
        body.add_joint(name=f"{platform.name}~{index}", type=mujoco.mjtJoint.mjJNT_SLIDE, axis=list(axis))
    body.add_joint(name=f"{platform.name}~ball", type=mujoco.mjtJoint.mjJNT_BALL)
    body.geoms[0].mass = legs.mass_kg
    foundation, stands = spec.body(base.name), place_on(base, platform)
    for name, foot, joint in zip(leg_names(platform.name), legs.feet, legs.joints, strict=True):
        length_m = math.dist(foot, compose_poses(stands, Pose(xyz=joint)).xyz)
        foundation.add_site(name=f"{name}~foot", pos=list(foot))
        body.add_site(name=f"{name}~joint", pos=list(joint))
        tendon = spec.add_tendon(name=name)
        tendon.wrap_site(f"{name}~foot")
        tendon.wrap_site(f"{name}~joint")
        tendon.limited, tendon.range = mujoco.mjtLimited.mjLIMITED_TRUE, list(legs.length_m)
        tendon.solref_limit, tendon.solimp_limit = list(PAD_SOLREF), list(PAD_SOLIMP)
        spring = spec.add_actuator(name=name, target=name, trntype=mujoco.mjtTrn.mjTRN_TENDON)
        spring.set_to_position(kp=STIFFNESS_N_M, kv=legs.damping_ns_m)
        spring.biasprm[0] = STIFFNESS_N_M * length_m
