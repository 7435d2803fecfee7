"""The joint of a fixture that a device moves, in MuJoCo's specification: a throttled cylinder, a belt, a carriage.

A carriage is held by a stiff spring that slips, as a leg of a hexapod is: elastic up to the force at which it slips,
which `robots.sim.loop.carriages` sets. Dry friction of MuJoCo would let a braked carriage creep.
"""

from __future__ import annotations

import math
from typing import Any

from robots.scene.sim_scene import AxisBody, BeltBody, CarriageBody
from robots.sim.physics.physics import mujoco
from robots.sim.physics.tool_body import PAD_SOLIMP, PAD_SOLREF

CARRIAGE_N_M = 4e6
"""Stiffness of a carriage in its brakes, and in the friction of its guides."""
_BRAKE_DAMPING_RATIO = 0.3
_BELT_KG = 1e4


def add_jaw(geom: Any, *, friction: float) -> None:
    """Give a geometry the surface of jaws: stiff, with this coefficient of friction with any other body."""
    geom.priority, geom.condim = 1, 4
    geom.solref, geom.solimp = list(PAD_SOLREF), list(PAD_SOLIMP)
    geom.friction[0] = friction


def add_belt(body: Any, geom: Any, name: str, belt: BeltBody) -> None:
    """Let the surface of a fixture run: the fixture slides at the speed of the belt and is set back after each step.

    It is so heavy that what it carries does not change its speed within a step.
    """
    body.add_joint(name=name, type=mujoco.mjtJoint.mjJNT_SLIDE, axis=list(belt.along))
    body.gravcomp = 1.0
    geom.mass = _BELT_KG


def add_axis(spec: Any, body: Any, geom: Any, name: str, axis: AxisBody) -> None:
    """Put a fixture on its joint, with a motor whose control is the force.

    Air that leaves through a throttle makes the speed: force and damping balance at the speed of the free axis. Weight
    is balanced, as by the guide of a cylinder.
    """
    kind = mujoco.mjtJoint.mjJNT_HINGE if axis.hinge else mujoco.mjtJoint.mjJNT_SLIDE
    joint = body.add_joint(name=name, type=kind, axis=list(axis.along))
    joint.limited, joint.range = mujoco.mjtLimited.mjLIMITED_TRUE, [0.0, axis.stroke]
    joint.solref_limit, joint.solimp_limit = list(PAD_SOLREF), list(PAD_SOLIMP)
    joint.damping[0] = axis.force / axis.speed
    body.gravcomp = 1.0
    geom.mass = axis.mass_kg
    motor = spec.add_actuator(name=name, target=name, trntype=mujoco.mjtTrn.mjTRN_JOINT)
    motor.set_to_motor()


def add_slide(spec: Any, body: Any, geom: Any, name: str, carriage: CarriageBody) -> None:
    """Put a fixture on its rail; its control is where its spring is without force."""
    joint = body.add_joint(name=name, type=mujoco.mjtJoint.mjJNT_SLIDE, axis=list(carriage.along))
    joint.limited, joint.range = mujoco.mjtLimited.mjLIMITED_TRUE, list(carriage.travel_m)
    joint.solref_limit, joint.solimp_limit = list(PAD_SOLREF), list(PAD_SOLIMP)
    geom.mass = carriage.mass_kg
    spring = spec.add_actuator(name=name, target=name, trntype=mujoco.mjtTrn.mjTRN_JOINT)
    spring.set_to_position(kp=CARRIAGE_N_M)


def damping_ns_m(carriage: CarriageBody, *, released: bool) -> float:
    """Return the damping of a carriage: that of its guides, or of its brakes, in which it does not ring."""
    braked = 2.0 * _BRAKE_DAMPING_RATIO * math.sqrt(CARRIAGE_N_M * carriage.mass_kg)
    return carriage.damping_ns_m if released else braked
