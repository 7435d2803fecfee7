"""A person's arm in a MuJoCo specification: moved bodies that collide with robots and parts, and nothing else."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from robots.scene.sim_scene import PersonBody
from robots.sim.physics.limb import BODIES, Limb
from robots.sim.physics.physics import mujoco

FOREARM_SHARE = 0.8
"""Thickness of a forearm relative to upper arm and hand; a hand therefore touches with its ball."""

# Collides only with geometries marked for contact with people; models use low bits.
_PEOPLE = 1 << 20
LIMB_KG = 3.0
"""Mass with which each body of an arm meets others: about the effective mass of an arm in ISO/TS 15066, annex A."""


@dataclass(frozen=True, kw_only=True)
class PersonIndices:
    """Indices of a person's bodies in the model's arrays: `qpos` (21,), `dof` (18,), `bodies` as in `BODIES`."""

    name: str
    qpos: NDArray[np.intp]
    dof: NDArray[np.intp]
    bodies: tuple[int, ...]


def body_names(person: str) -> tuple[str, ...]:
    """Return the names of a person's bodies, from the shoulder on."""
    return tuple(f"{person}/{body}" for body in BODIES)


def add_person(spec: Any, person: PersonBody) -> None:
    """Add the bodies of an arm at its rest pose; the simulation loop moves them."""
    limb, hand = Limb(person), np.array(person.hand_rests)
    pose = limb.pose(hand, limb.hanging(hand))
    forearm_m = FOREARM_SHARE * person.radius_m
    kinds = mujoco.mjtGeom
    shapes = (
        (kinds.mjGEOM_CAPSULE, [person.radius_m, person.upper_arm_m / 2.0, 0.0]),
        (kinds.mjGEOM_CAPSULE, [forearm_m, person.forearm_m / 2.0, 0.0]),
        (kinds.mjGEOM_SPHERE, [person.radius_m, 0.0, 0.0]),
    )
    for name, (kind, size), xyz, wxyz in zip(body_names(person.name), shapes, pose.xyz, pose.wxyz, strict=True):
        body = spec.worldbody.add_body(name=name, pos=xyz.tolist(), quat=wxyz.tolist(), gravcomp=1.0)
        body.add_freejoint(name=name)
        geom = body.add_geom(name=name, type=kind, size=size, rgba=list(person.rgba))
        geom.contype, geom.conaffinity, geom.mass = _PEOPLE, 0, LIMB_KG


def let_people_touch(spec: Any) -> None:
    """Enable contact of people with everything but people; call it on the complete specification."""
    for geom in spec.geoms:
        touches_something = bool(geom.contype or geom.conaffinity)
        if touches_something and geom.contype != _PEOPLE:
            geom.conaffinity |= _PEOPLE


def person_indices(model: Any, person: PersonBody) -> PersonIndices:
    """Return the indices of a person's bodies in a compiled model."""
    names = body_names(person.name)
    return PersonIndices(
        name=person.name,
        qpos=_ints(model.joint(name).qposadr[0] + i for name in names for i in range(7)),
        dof=_ints(model.joint(name).dofadr[0] + i for name in names for i in range(6)),
        bodies=tuple(int(model.body(name).id) for name in names),
    )


def _ints(values: Iterable[Any]) -> NDArray[np.intp]:
    return np.array([int(value) for value in values], dtype=np.intp)
